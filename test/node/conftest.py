"""Fixtures of the tests that talk over DDS; without ROS those tests are skipped, by name."""

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import pytest

# Read when the message classes are imported: their fields are checked only then.
os.environ["ROS_PYTHON_CHECK_FIELDS"] = "1"


@pytest.fixture(scope="session")
def domain() -> Iterator[int]:
    """A DDS domain on this computer that nobody else uses."""
    from domain_coordinator import domain_id

    with domain_id() as number, pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", str(number))
        patch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        # What a killed process leaves in shared memory can keep later ones from meeting.
        patch.setenv("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")
        yield number


@pytest.fixture(scope="module")
def graph(domain):
    """A node of this process."""
    from .graph import Graph

    graph = Graph()
    yield graph
    graph.close()


@pytest.fixture(scope="module")
def start_node(domain):
    """Start nodes by their module, which end with the test module at the latest."""
    from .process import NodeProcess

    started = []

    def start_process(module: str, *arguments: str) -> NodeProcess:
        started.append(NodeProcess(module, *arguments))
        return started[-1]

    yield start_process
    for process in started:
        process.end()


@pytest.fixture(scope="module")
def start(start_node):
    """Start predictors with ROS arguments."""
    return lambda *arguments: start_node("predictor", "--ros-args", *arguments)


@contextmanager
def predictor_here(given: Mapping[str, Any]) -> Iterator[Any]:
    """A predictor within this process, without anything between, with parameters."""
    import rclpy
    from rclpy.signals import SignalHandlerOptions

    from sfd_hbm_ros.node.predictor import Predictor

    parameters = (part for key, value in given.items() for part in ("-p", f"{key}:={value}"))
    rclpy.init(args=["--ros-args", *parameters], signal_handler_options=SignalHandlerOptions.NO)
    node = Predictor()
    yield node
    node.close()
    node.destroy_node()
    rclpy.shutdown()
