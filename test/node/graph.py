"""The tests' side of the ROS graph; importing it without ROS skips the test that does."""

import time
import warnings
from collections.abc import Callable, Mapping
from typing import Any

import pytest

rclpy = pytest.importorskip("rclpy")
with warnings.catch_warnings():
    # rclpy imports lark with its first message; lark imports what Python 3.11 deprecates.
    warnings.simplefilter("ignore", DeprecationWarning)
    import rosidl_generator_py  # noqa: F401

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus  # noqa: E402
from geometry_msgs.msg import WrenchStamped  # noqa: E402
from lifecycle_msgs.srv import ChangeState, GetState  # noqa: E402
from rcl_interfaces.msg import SetParametersResult  # noqa: E402
from rcl_interfaces.srv import GetParameters, SetParametersAtomically  # noqa: E402
from rclpy.context import Context  # noqa: E402
from rclpy.duration import Duration  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from rclpy.parameter import Parameter, parameter_value_to_python  # noqa: E402
from rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile  # noqa: E402
from rclpy.time import Time  # noqa: E402
from sensor_msgs.msg import JointState, PointCloud2  # noqa: E402
from std_msgs.msg import Header  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402

from sfd_hbm_ros.node.messages.common import speed_message  # noqa: E402

LIMIT = 60.0  # s; joining a node alone takes up to 3 s on an idle computer
Numbers = dict[str, float]
Strings = dict[str, str]
# What a supervisor may demand: it hears of a node that is stuck as of one that has died.
HEARTBEAT = QoSProfile(
    depth=1,
    deadline=Duration(seconds=0.5),
    liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
    liveliness_lease_duration=Duration(seconds=1.0),
)
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Graph:
    """A node with an executor, in a context of its own."""

    def __init__(self) -> None:
        self.context = Context()
        rclpy.init(context=self.context)
        self.node = rclpy.create_node("tests", context=self.context)
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)
        self._clients: dict[str, Any] = {}

    def close(self) -> None:
        self._executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()

    def until(
        self,
        condition: Callable[[], Any],
        what: str,
        between: Any = None,
        limit: float = LIMIT,
    ) -> Any:
        """Spin until a condition holds and return what it returned."""
        end = time.monotonic() + limit
        while time.monotonic() < end:
            if result := condition():
                return result
            if between is not None:
                between()
            self._executor.spin_once(timeout_sec=0.05)
        return pytest.fail(f"{what}: not within {limit} s")

    def collect(self, kind: Any, topic: str, take: Callable[[Any], None], qos: Any = 100) -> None:
        """Hand every message on a topic to a function."""
        self.node.create_subscription(kind, topic, take, qos)

    def call(self, kind: Any, service: str, request: Any) -> Any:
        """Call a service and return its response."""
        if service not in self._clients:
            self._clients[service] = self.node.create_client(kind, service)
        client = self._clients[service]
        self.until(client.service_is_ready, f"{service} is found")
        future = client.call_async(request)
        self.until(future.done, f"{service} answers")
        return future.result()


class Remote:
    """A predictor as its users see it.

    Parameters
    ----------
    graph : Graph
        The tests' node.
    name : str
        The predictor's name with its namespace.
    speed : str
        The topic from which it takes the speed.
    """

    def __init__(self, graph: Graph, name: str = "/predictor", speed: str = "~/speed") -> None:
        self.graph = graph
        self.name = name
        self.eccentricity: dict[int, JointState] = {}
        self.harmonics: dict[int, JointState] = {}
        self.statuses: dict[str, DiagnosticStatus] = {}
        self.warnings: list[tuple[int, DiagnosticStatus]] = []
        self.curves: list[PointCloud2] = []
        self.reports = 0
        self.heartbeats = 0
        node = graph.node
        self.speed = node.create_publisher(JointState, speed.replace("~", name), 10)
        self.load = node.create_publisher(WrenchStamped, f"{name}/load", 10)
        graph.collect(JointState, f"{name}/eccentricity", self._keep(self.eccentricity))
        graph.collect(JointState, f"{name}/harmonics", self._keep(self.harmonics))
        graph.collect(DiagnosticArray, "/diagnostics", self._note)
        graph.collect(Header, f"{name}/heartbeat", self._count, HEARTBEAT)
        graph.collect(DiagnosticArray, f"{name}/jump_warning", self._warn, LATCHED)
        graph.collect(PointCloud2, f"{name}/response_curve", self.curves.append, LATCHED)

    def _keep(self, kept: dict[int, JointState]) -> Callable[[JointState], None]:
        return lambda message: kept.update({nanoseconds(message.header): message})

    def _note(self, message: DiagnosticArray) -> None:
        if message.status[0].name.startswith(f"{self.name[1:]}: "):
            self.reports += 1
            self.statuses = {status.name.split(": ")[1]: status for status in message.status}

    def _warn(self, message: DiagnosticArray) -> None:
        self.warnings.append((nanoseconds(message.header), message.status[0]))

    def _count(self, message: Header) -> None:
        self.heartbeats += 1

    def now(self) -> int:
        """Time of the tests' clock [ns]."""
        return int(self.graph.node.get_clock().now().nanoseconds)

    def meet(self, speed: float = 100.0) -> None:
        """Publish a speed until predictions arrive: from then on none is lost."""
        self.graph.until(
            lambda: self.eccentricity and self.harmonics and self.statuses and self.heartbeats,
            f"{self.name} answers",
            between=lambda: self.send(speed, self.now()),
        )
        self.graph.until(lambda: self.load.get_subscription_count(), "~/load is found")

    def send(self, speed: float, stamp: int) -> None:
        """Publish a speed [rad/s] with a stamp [ns]."""
        self.speed.publish(speed_message(Time(nanoseconds=stamp), speed, 0.0))

    def push(self, station: str, force: tuple[float, float], stamp: int) -> None:
        """Publish a load [N] with a stamp [ns]."""
        message = WrenchStamped()
        message.header.frame_id = station
        message.header.stamp = Time(nanoseconds=stamp).to_msg()
        message.wrench.force.x, message.wrench.force.y = force
        self.load.publish(message)

    def predict(self, speed: float, stamp: int | None = None) -> tuple[Numbers, Numbers]:
        """Ask for a prediction and return its eccentricities and harmonics by their names."""
        stamp = self.now() if stamp is None else stamp
        self.send(speed, stamp)
        return self.answer(stamp)

    def answer(self, stamp: int) -> tuple[Numbers, Numbers]:
        """Wait for the prediction with a stamp [ns]."""
        both = self.eccentricity, self.harmonics
        self.graph.until(lambda: all(stamp in kept for kept in both), f"prediction at {stamp} ns")
        eccentricity, harmonics = (kept[stamp] for kept in both)
        return numbers(eccentricity), numbers(harmonics)

    def until_status(
        self, subject: str, level: bytes, part: str, between: Any = None
    ) -> DiagnosticStatus:
        """Wait until a status has a level and its message a part."""

        def found() -> DiagnosticStatus | None:
            status = self.statuses.get(subject)
            return status if status and status.level == level and part in status.message else None

        status: DiagnosticStatus = self.graph.until(found, f"{subject} says {part!r}", between)
        return status

    def until_warning(self, level: bytes, part: str = "", speed: float = 0.0) -> Strings:
        """Wait until the warning has a level and its message a part; return its values.

        A speed [rad/s] other than 0 is published meanwhile.
        """
        seen = len(self.warnings)

        def found() -> DiagnosticStatus | None:
            new = (status for _, status in self.warnings[seen:])
            return next((one for one in new if one.level == level and part in one.message), None)

        def between() -> None:
            if speed:
                self.send(speed, self.now())

        return strings(self.graph.until(found, f"warning {level!r} {part!r}", between))

    def order(self, service: str) -> tuple[bool, str]:
        """Call a service without arguments and return its answer."""
        response = self.graph.call(Trigger, f"{self.name}/{service}", Trigger.Request())
        return response.success, response.message

    def until_dropped(self, source: str, number: int) -> None:
        """Wait until so many inputs are said to have been dropped from a source."""

        def dropped() -> int:
            values = {pair.key: pair.value for pair in self.statuses["Inputs"].values}
            return int(values[f"{source}: dropped"])

        self.graph.until(lambda: dropped() >= number, f"{source} dropped {number}")

    def beats(self, number: int = 5) -> None:
        """Wait for heartbeats."""
        wanted = self.heartbeats + number
        self.graph.until(lambda: self.heartbeats >= wanted, "the heart beats")

    def set(self, values: Mapping[str, Any]) -> SetParametersResult:
        """Set parameters together."""
        parameters = [
            Parameter(name, value=value).to_parameter_msg() for name, value in values.items()
        ]
        request = SetParametersAtomically.Request(parameters=parameters)
        service = f"{self.name}/set_parameters_atomically"
        return self.graph.call(SetParametersAtomically, service, request).result

    def get(self, *names: str) -> list[Any]:
        """Return the values of parameters."""
        request = GetParameters.Request(names=names)
        response = self.graph.call(GetParameters, f"{self.name}/get_parameters", request)
        return [parameter_value_to_python(value) for value in response.values]

    def change_state(self, *labels: str) -> list[bool]:
        """Ask for lifecycle transitions and return which succeeded."""
        successes = []
        for label in labels:
            request = ChangeState.Request()
            request.transition.label = label
            response = self.graph.call(ChangeState, f"{self.name}/change_state", request)
            successes.append(response.success)
        return successes

    def state(self) -> str:
        """Return the lifecycle state."""
        response = self.graph.call(GetState, f"{self.name}/get_state", GetState.Request())
        return str(response.current_state.label)

    def restart(self) -> None:
        """Forget loads, changed values and the last solution."""
        assert self.change_state("deactivate", "cleanup", "configure", "activate") == [True] * 4


def strings(status: DiagnosticStatus) -> Strings:
    """Return the values of a status by their keys."""
    return {pair.key: pair.value for pair in status.values}


def numbers(message: JointState) -> Numbers:
    """Return the named numbers of a message."""
    return dict(zip(message.name, message.position, strict=True))


def nanoseconds(header: Header) -> int:
    """Return the stamp of a message [ns]."""
    return int(Time.from_msg(header.stamp).nanoseconds)
