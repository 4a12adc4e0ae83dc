"""Requests about parameters and others: each is answered, and refused in words that help."""

import signal

import pytest
import yaml

from .graph import Context, Graph, Remote, rclpy  # first, as it skips the file without ROS

# isort: split
from lifecycle_msgs.srv import GetAvailableStates, GetState
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterValue
from rcl_interfaces.srv import ListParameters, SetParameters
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import qos_profile_parameters
from std_srvs.srv import SetBool, Trigger

from .process import PAPER_ROTOR, NodeProcess

NAME = "/asked"
LONGEST = 200  # characters of a sentence


@pytest.fixture(scope="module")
def process(start, tmp_path_factory) -> NodeProcess:
    file = tmp_path_factory.mktemp("state") / "state.json"
    return start(
        *("-p", f"machine_file:={PAPER_ROTOR}", "-p", f"state_file:={file}"),
        *("-p", "stale_after:=3600.0", "-r", f"__node:={NAME[1:]}"),
    )


@pytest.fixture(scope="module")
def predictor(graph: Graph, process: NodeProcess) -> Remote:
    remote = Remote(graph, NAME)
    remote.meet()
    return remote


def set_each(remote: Remote, *parameters: ParameterMessage) -> list[tuple[bool, str]]:
    """Set parameters, each for itself, and return which were set, or why not."""
    request = SetParameters.Request(parameters=list(parameters))
    answer = remote.graph.call(SetParameters, f"{NAME}/set_parameters", request)
    return [(result.successful, result.reason) for result in answer.results]


def message(name: str, value: object) -> ParameterMessage:
    return Parameter(name, value=value).to_parameter_msg()


def test_a_type_that_is_none_spoils_no_other_answer(predictor):
    none = ParameterMessage(name="harmonics", value=ParameterValue(type=99))
    answers = set_each(
        predictor,
        message("frame_id", "shaft"),
        none,
        message("dampers.damper_1.viscosity", -1.0),
        message("publish_rate", 50.0),
    )
    assert [done for done, _ in answers] == [True, False, False, True]
    assert answers[1][1] == "harmonics must have a type of ParameterType, not 99"
    assert answers[2][1].startswith("dampers.damper_1.viscosity must be a finite number [Pa s]")
    assert predictor.get("frame_id", "publish_rate") == ["shaft", 50.0]


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("harmoncis", "harmoncis is unknown (did you mean harmonics?)"),
        ("qwertz", "qwertz is unknown; `ros2 param list` shows those that there are"),
        (
            "dampers.damper_1.clearance",
            "dampers.damper_1.clearance is fixed while there is a machine: change it in the "
            "machine file, then clean the node up and configure it",
        ),
        ("shaft.0.length", "shaft.0.length is fixed while there is a machine: change it in the"),
        (
            "autostart",
            "autostart is fixed: it is read when the node starts, so restart the node with "
            "-p autostart:=VALUE",
        ),
        ("start_type_description_service", "start_type_description_service is fixed: it is read"),
    ],
)
def test_refusals_are_short_and_say_how_to_change_what_is_fixed(predictor, name, sentence):
    [(done, reason)] = set_each(predictor, message(name, False))
    assert not done
    assert reason.startswith(sentence)
    assert len(reason) < LONGEST


def test_ros2_param_load_of_ros2_param_dump_succeeds(predictor, tmp_path):
    """As ros2param does it: all names, their values as YAML, and its client to load them."""
    predictor.set({"unbalance.disk_1.magnitude": 2.0e-4, "unbalance.disk_3.phase": 0.5})
    request = ListParameters.Request()
    listed = predictor.graph.call(ListParameters, f"{NAME}/list_parameters", request)
    names = sorted(listed.result.names)
    before = predictor.get(*names)
    file = tmp_path / "dump.yaml"
    file.write_text(dump(names, before))
    # What was changed since comes back as well, a list of another length included.
    changed = {
        "unbalance.stations": ["disk_2"],
        "unbalance.magnitudes": [1.0e-4],
        "unbalance.phases": [0.1],
        "alarm.time_warn": 50.0,
        "alarm.time_error": 40.0,
        "gravity": True,
    }
    for meanwhile in ({}, changed):
        assert not meanwhile or predictor.set(meanwhile).successful
        client = AsyncParameterClient(predictor.graph.node, NAME)
        future = client.load_parameter_file(str(file))
        predictor.graph.until(future.done, "the file is loaded")
        results = future.result().results
        assert len(results) == len(names)
        assert [result.reason for result in results if not result.successful] == []
        assert predictor.get(*names) == before


def dump(names: list[str], values: list[object]) -> str:
    """Return what `ros2 param dump` writes."""
    nested: dict = {}
    for name, value in zip(names, values, strict=True):
        *groups, last = name.split(".")
        place = nested
        for group in groups:
            place = place.setdefault(group, {})
        place[last] = list(value) if hasattr(value, "typecode") else value
    return yaml.dump({NAME: {"ros__parameters": nested}}, default_flow_style=False)


CALLS = {
    "get_state": (GetState, GetState.Request()),
    "get_available_states": (GetAvailableStates, GetAvailableStates.Request()),
    "acknowledge": (Trigger, Trigger.Request()),
    "shelve": (SetBool, SetBool.Request()),
    "set_parameters": (SetParameters, SetParameters.Request()),
}


def test_every_one_of_many_calls_at_once_is_answered(predictor, process):
    """They come while the predictor stands still: thirty wait at each service as it goes on."""
    context = Context()
    rclpy.init(context=context)
    node = rclpy.create_node("crowd", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    try:
        clients = [
            (
                node.create_client(kind, f"{NAME}/{name}", qos_profile=qos_profile_parameters),
                request,
            )
            for name, (kind, request) in CALLS.items()
            for _ in range(15)
        ]
        predictor.graph.until(
            lambda: all(client.service_is_ready() for client, _ in clients), "all are found"
        )
        process.send(signal.SIGSTOP)
        futures = [client.call_async(request) for _ in range(2) for client, request in clients]
        process.send(signal.SIGCONT)
        predictor.graph.until(
            lambda: all(future.done() for future in futures),
            "all are answered",
            between=lambda: [executor.spin_once(timeout_sec=0.0) for _ in range(100)],
        )
    finally:
        executor.shutdown()
        node.destroy_node()
        context.try_shutdown()
