"""Nothing that arrives ends the predictor, and after all of it the predictor answers rightly."""

import array
import math
import random

import pytest

pytest.importorskip("rclpy")

from geometry_msgs.msg import WrenchStamped
from lifecycle_msgs.srv import ChangeState
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from sensor_msgs.msg import JointState

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import read_machine

from .graph import Remote
from .process import PAPER_ROTOR

ROUNDS = 250  # of four malformed things each
NUMBERS = (math.nan, math.inf, -math.inf, -1.0, -1e300, 1e300, 5e-324, 0.0, -0.0)
NAMES = (
    "dampers.damper_1.viscosity",
    "dampers.damper_1.centering_stiffness",
    "unbalance.disk_2.magnitude",
    "gravity",
    "harmonics",
    "publish_rate",
    "stale_after",
    "machine_file",
    "autostart",
    "use_sim_time",
    "dampers.damper_9.viscosity",
    "no.such.parameter",
    "",
    ".",
    "x" * 10_000,
)
STATIONS = ("", "disk_9", "disk_3 ", "x" * 10_000, "\u0000", "\u00e9\u4e16", "dampers.damper_1")
POSSIBLE_WHILE_ACTIVE = (4, 7)  # deactivate, shut down


class Malformed:
    """Makes things that the predictor must refuse, or survive."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)

    def speed(self) -> JointState:
        pick = self._random
        message = JointState(name=["rotor"] * pick.randrange(3))
        length = pick.choice([0, 1, 1, 1, 2, 3, 100_000])
        message.velocity = array.array("d", [pick.choice(NUMBERS[:5])] * length)
        message.position = [pick.choice(NUMBERS)] * pick.randrange(3)
        self._stamp(message)
        return message

    def load(self) -> WrenchStamped:
        pick = self._random
        message = WrenchStamped()
        message.wrench.force.x = pick.choice(NUMBERS)
        message.wrench.force.y = pick.choice(NUMBERS[:3])
        message.wrench.torque.z = pick.choice(NUMBERS)
        message.header.frame_id = pick.choice([*STATIONS, "disk_3"])
        self._stamp(message)
        return message

    def parameter(self) -> Parameter:
        return Parameter(name=self._random.choice(NAMES), value=self._value())

    def transition(self) -> ChangeState.Request:
        request = ChangeState.Request()
        impossible = [i for i in range(256) if i not in POSSIBLE_WHILE_ACTIVE]
        request.transition.id = self._random.choice(impossible)
        request.transition.label = self._random.choice(["", "", "no such transition"])
        return request

    def _stamp(self, message: JointState | WrenchStamped) -> None:
        message.header.stamp.sec = self._random.choice([0, 1, -1, -(2**31), 2**31 - 1])
        message.header.stamp.nanosec = self._random.choice([0, 1, 10**9, 2**32 - 1])

    def _value(self) -> ParameterValue:
        """Return a value that no parameter of the predictor may have."""
        pick = self._random
        kinds = ParameterType
        return pick.choice(
            [
                ParameterValue(type=kinds.PARAMETER_NOT_SET),
                ParameterValue(type=pick.choice([99, 255])),
                ParameterValue(type=kinds.PARAMETER_DOUBLE, double_value=pick.choice(NUMBERS[:5])),
                ParameterValue(type=kinds.PARAMETER_INTEGER, integer_value=-(2**63)),
                ParameterValue(type=kinds.PARAMETER_BYTE_ARRAY, byte_array_value=[b"\xff"]),
                ParameterValue(type=kinds.PARAMETER_DOUBLE_ARRAY, double_array_value=[0.028]),
                ParameterValue(type=kinds.PARAMETER_INTEGER_ARRAY, integer_array_value=[7] * 9999),
                ParameterValue(type=kinds.PARAMETER_STRING_ARRAY, string_array_value=[]),
                ParameterValue(type=kinds.PARAMETER_BOOL_ARRAY, bool_array_value=[True]),
            ]
        )


def test_a_thousand_malformed_messages_and_requests(graph, start):
    process = start("-p", f"machine_file:={PAPER_ROTOR}", "-p", "stale_after:=3600.0")
    remote = Remote(graph)
    remote.meet()
    malformed = Malformed(seed=20240607)
    for turn in range(ROUNDS):
        remote.speed.publish(malformed.speed())
        remote.load.publish(malformed.load())
        # The answers also keep this test from outrunning the predictor.
        assert not graph.call(
            ChangeState, "/predictor/change_state", malformed.transition()
        ).success
        parameters = [malformed.parameter() for _ in range(1 + turn % 3)]
        if turn % 2:
            request = SetParameters.Request(parameters=parameters)
            response = graph.call(SetParameters, "/predictor/set_parameters", request)
            assert not any(result.successful for result in response.results)
        else:
            atomic = SetParametersAtomically.Request(parameters=parameters)
            service = "/predictor/set_parameters_atomically"
            response = graph.call(SetParametersAtomically, service, atomic)
            assert not response.result.successful
    assert process.running
    assert remote.state() == "active"
    # The speed is best effort of depth 1: a few may be lost.
    remote.until_dropped("/predictor/speed", ROUNDS * 3 // 4)
    remote.until_dropped("/predictor/load", ROUNDS)
    remote.until_dropped("requests", 1)
    eccentricity, _ = remote.predict(400.0)
    journal = solve(HarmonicBalance(read_machine(PAPER_ROTOR), Harmonics(7)), 400.0).journals
    expected = journal["damper_1"].eccentricity_max
    assert eccentricity["damper_1/max"] == pytest.approx(expected, rel=1e-9)
    assert "Traceback" not in process.said()
