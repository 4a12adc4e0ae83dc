"""The service that has the solver check itself while the predictions go on."""

from __future__ import annotations

from collections.abc import Iterator

from diagnostic_msgs.srv import SelfTest
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.task import Future

from sfd_hbm_ros.machine import read_machine
from sfd_hbm_ros.machine.shipped import shipped
from sfd_hbm_ros.node.diagnostics import Status
from sfd_hbm_ros.node.messages.common import status_message
from sfd_hbm_ros.node.slices import PERIOD, advance
from sfd_hbm_ros.report.paper.cases import (
    cases_file,
    published_jumps,
    published_peak,
    read_cases,
)
from sfd_hbm_ros.response.self_test import Finding, self_test
from sfd_hbm_ros.response.warning.settings import Level

_ROTOR = "paper_rotor.yaml"


class SelfTestService:
    """Serves `~/self_test`, a slice of work at a time; another call waits until one is done.

    What is checked is the paper's rotor, whatever the machine of the node is.

    Parameters
    ----------
    node : Node
        The node.
    """

    def __init__(self, node: Node) -> None:
        self._name = node.get_fully_qualified_name().lstrip("/")
        self._work: Iterator[None] = iter(())
        self._done = Future()
        # A group of its own: while a call is being served, nothing else of its group is.
        own = MutuallyExclusiveCallbackGroup()
        node.create_service(SelfTest, "~/self_test", self._serve, callback_group=own)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(PERIOD, self._go_on, clock=steady, autostart=False)

    async def _serve(self, _: SelfTest.Request, response: SelfTest.Response) -> SelfTest.Response:
        findings: list[Finding] = []
        self._work = _checked(findings)
        self._done = Future()
        self._timer.reset()
        await self._done
        response.id = self._name
        response.passed = bytes([all(finding.passed for finding in findings)])
        response.status = [
            status_message(self._name, _ROTOR, _status(finding)) for finding in findings
        ]
        return response

    def _go_on(self) -> None:
        """Do a slice of the work."""
        try:
            if advance(self._work):
                return
        except Exception as error:  # whatever it is, it is the answer
            self._done.set_exception(error)
        else:
            self._done.set_result(None)
        self._timer.cancel()


def _checked(findings: list[Finding]) -> Iterator[None]:
    """Do the checks, and pause now and then."""
    cases = read_cases(cases_file())
    published = published_peak(cases), published_jumps(cases)
    for finding in self_test(read_machine(shipped(_ROTOR)), *published):
        if finding is not None:
            findings.append(finding)
        yield


def _status(finding: Finding) -> Status:
    """Return how a check ended."""
    level = Level.OK if finding.passed else Level.ERROR
    verdict = "agrees with" if finding.passed else "departs from"
    values = {
        f"deviation [{finding.unit}]": f"{finding.deviation:.3g}",
        f"limit [{finding.unit}]": f"{finding.limit:.3g}",
    }
    return Status(f"self-test, {finding.name}", level, f"{verdict} {finding.source}", values)
