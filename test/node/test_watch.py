"""The response curve, the warning of a jump and its alarm, through the real node.

The paper's rotor with 503.9 g mm on disk 2 jumps at about 4160 rpm on the way up and at about
3985 rpm on the way down, as the theory of circular orbits has it.
"""

import math
import time
from typing import NamedTuple

import numpy as np
import pytest

from sfd_hbm_ros.machine import override, read_machine

from .graph import LATCHED, PointCloud2, Remote, nanoseconds, numbers, strings

# isort: split
from geometry_msgs.msg import PolygonStamped
from std_srvs.srv import SetBool

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics
from sfd_hbm_ros.node.messages.curve import curve_point
from sfd_hbm_ros.response.curves.curve import response_curve

from .process import PAPER_ROTOR

RPM = math.pi / 30.0  # rad/s
OK, WARN, ERROR = b"\x00", b"\x01", b"\x02"
UNBALANCE = {"unbalance.disk_2.magnitude": 5.039e-4}
GIVEN = {
    "machine_file": PAPER_ROTOR,
    "harmonics": 1,
    "stale_after": 3600.0,
    "publish_rate": 1000.0,
    "speed.min": 350.0,
    "speed.max": 500.0,
    "curve.detached": False,
    "alarm.margin_warn_rpm": 0.0,
    "alarm.margin_error_rpm": 0.0,
    "alarm.time_warn": 3.0,
    "alarm.time_error": 1.0,
    "alarm.eccentricity_warn": 0.0,
    "alarm.eccentricity_error": 0.0,
    "alarm.off_delay": 0.3,
    **UNBALANCE,
}


class Sample(NamedTuple):
    """A prediction: its stamp [ns], the speed [rpm] and the eccentricity."""

    stamp: int
    speed: float
    eccentricity: float


@pytest.fixture(scope="module")
def running(graph, start) -> Remote:
    start(*(part for name, value in GIVEN.items() for part in ("-p", f"{name}:={value}")))
    remote = Remote(graph)
    remote.meet(370.0)
    graph.until(lambda: remote.curves, "a curve comes")
    return remote


@pytest.fixture
def predictor(running: Remote) -> Remote:
    """The predictor at 370 rad/s, where there is one response, with nothing to acknowledge."""
    values = {name: value for name, value in GIVEN.items() if name != "machine_file"}
    assert running.set({**values, "alarm.latch": False}).successful
    running.until_warning(OK, "above the present speed", 370.0)
    assert running.order("acknowledge")[0]
    return running


def run(
    remote: Remote,
    first: float,
    last: float,
    seconds: float,
    pause: float = 0.02,
    part_predicted: float = 0.5,
) -> list[Sample]:
    """Publish speeds from one to another [rpm] at 50 Hz and return what was predicted of them."""
    sent, begin = {}, time.monotonic()
    while (part := (time.monotonic() - begin) / seconds) < 1.0:
        stamp, speed = remote.now(), first + part * (last - first)
        sent[stamp] = speed
        remote.send(speed * RPM, stamp)
        wake = time.monotonic() + pause
        remote.graph.until(lambda wake=wake: time.monotonic() >= wake, "time passes")
    found = [
        Sample(stamp, speed, numbers(remote.eccentricity[stamp])["damper_1/max"])
        for stamp, speed in sent.items()
        if stamp in remote.eccentricity
    ]
    assert len(found) > part_predicted * len(sent)
    return found


def jump(found: list[Sample]) -> tuple[int, float]:
    """The stamp and speed [rpm] of the prediction after the greatest change."""
    changes = np.abs(np.diff([sample.eccentricity for sample in found]))
    assert changes.max() > 0.1
    after = found[int(np.argmax(changes)) + 1]
    return after.stamp, after.speed


@pytest.mark.parametrize(
    ("first", "last", "fold", "key", "branch"),
    [
        (4010.0, 4190.0, 4160.0, "run_up_jump_rpm", "upper"),
        (4130.0, 3950.0, 3985.5, "coast_down_jump_rpm", "lower"),
    ],
    ids=["run-up", "coast-down"],
)
def test_a_jump_is_warned_of_ahead_and_not_after_it(predictor, first, last, fold, key, branch):
    if first > last:  # a coast-down begins above both jumps
        predictor.predict(4190.0 * RPM)
    # what the speed did before is forgotten, lest its step count as an acceleration
    assert predictor.change_state("deactivate", "activate") == [True, True]
    steady = predictor.until_warning(OK, "the present speed", first * RPM)
    predictor.warnings.clear()
    found = run(predictor, first, last, 9.0)
    came, speed = jump(found)
    assert abs(speed - fold) < 3.0  # a few speeds come between two predictions at most
    before = [(stamp, status) for stamp, status in predictor.warnings if stamp < came]
    [warned, reported] = (
        next(came - stamp for stamp, status in before if status.level == level) * 1e-9
        for level in (WARN, ERROR)
    )
    assert 2.0 < warned < 3.2
    assert 0.5 < reported < 1.2
    values = strings(before[-1][1])
    assert (values["branch"], values["bistable"]) == (branch, "true")
    assert float(values[key]) == pytest.approx(fold, abs=1.0)
    after = predictor.until_warning(OK, "", last * RPM)
    assert after["branch"] == "single"
    assert int(after["occurrences"]) <= int(steady["occurrences"]) + 1  # without chatter


def test_the_curve_is_that_of_the_library_and_waits_for_late_comers(predictor):
    late: list[PointCloud2] = []
    topic = f"{predictor.name}/response_curve"
    predictor.graph.collect(PointCloud2, topic, late.append, LATCHED)
    predictor.graph.until(lambda: late, "the curve is latched")
    [message] = late
    points = np.frombuffer(bytes(message.data), curve_point(["damper_1"]))
    machine = read_machine(PAPER_ROTOR)
    for path, value in UNBALANCE.items():
        machine = override(machine, path, value)
    curve = response_curve(HarmonicBalance(machine, Harmonics(1)), 350.0, 500.0)
    met = points[points["detached"] == 0]
    np.testing.assert_allclose(met["speed"], np.concatenate([b.speed for b in curve.branches]))
    expected = np.concatenate([branch.worst_eccentricity for branch in curve.branches])
    np.testing.assert_allclose(met["eccentricity"], expected, rtol=1e-9)


def test_a_change_outdates_the_curve_until_another_comes(predictor):
    before = nanoseconds(predictor.curves[-1].header)
    assert predictor.set({"unbalance.disk_2.magnitude": 2.0e-4}).successful
    predictor.until_warning(OK, "of no use any more", 370.0)
    predictor.graph.until(
        lambda: nanoseconds(predictor.curves[-1].header) > before, "a new curve comes"
    )
    values = predictor.until_warning(OK, "No jump ahead", 400.0)
    assert values["model_age_s"] == "0"
    assert values["margin_rpm"] == values["time_to_jump_s"] == "inf"
    assert values["bistable"] == "false"


def test_recompute_brings_another_curve(predictor):
    number = len(predictor.curves)
    assert predictor.order("recompute") == (True, "the response curve is being computed")
    predictor.graph.until(lambda: len(predictor.curves) > number, "a new curve comes")


def test_the_other_branch_is_published(predictor):
    predictor.predict(4100.0 * RPM)
    eccentricity, _ = predictor.predict(4100.0 * RPM)
    upper, lower = eccentricity["damper_1/max"], eccentricity["damper_1/other_branch/max"]
    assert upper > 0.7 > 0.5 > lower
    predictor.predict(4190.0 * RPM)
    eccentricity, _ = predictor.predict(4100.0 * RPM)
    assert eccentricity["damper_1/max"] == pytest.approx(lower, rel=1e-6)
    assert eccentricity["damper_1/other_branch/max"] == pytest.approx(upper, rel=1e-6)


def test_alarm_is_acknowledged_reset_and_shelved(predictor):
    near, far = 4150.0 * RPM, 4000.0 * RPM
    changes = {"alarm.margin_warn_rpm": 40.0, "alarm.time_warn": 0.0, "alarm.time_error": 0.0}
    assert predictor.set({**changes, "alarm.latch": True}).successful
    predictor.until_warning(OK, "the present speed", far)
    predictor.until_warning(WARN, "to be acknowledged", near)
    assert predictor.order("reset") == (False, "refused, since the alarm is still active")
    assert predictor.order("acknowledge") == (True, "acknowledged")
    predictor.until_warning(WARN, "; acknowledged", near)
    shelve(predictor, True)
    assert predictor.until_warning(OK, "shelved", near)["alarm"] == "shelved"
    shelve(predictor, False)
    predictor.until_warning(WARN, "; acknowledged", near)
    predictor.until_warning(WARN, "acknowledged and to be reset", far)
    assert predictor.order("reset") == (True, "reset")
    assert predictor.until_warning(OK, "", far)["alarm"] == "normal"


def shelve(remote: Remote, hide: bool) -> None:
    request = SetBool.Request(data=hide)
    assert remote.graph.call(SetBool, f"{remote.name}/shelve", request).success


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        ({"alarm.time_error": 3.0}, "alarm.time_error must be below time_warn, 3 s"),
        ({"alarm.deadband": 1.0}, "alarm.deadband must be a finite number of at least 0"),
        ({"alarm.margin_warn_rpm": math.nan}, "alarm.margin_warn_rpm must be a finite number"),
        ({"alarm.latch": 1}, "alarm.latch must be true or false"),
        ({"speed.min": 500.0}, "speed.max must be above speed.min, 500 rad/s, not 500"),
        ({"speed.max": 0.0}, "speed.max must be a number from 0.1 to 100000 [rad/s]"),
        ({"curve.attempts": 0}, "curve.attempts must be an integer from 1 to 100"),
        ({"state_file": "other"}, "state_file is fixed: it is read when the node starts"),
    ],
)
def test_values_that_do_not_go_together_are_refused(predictor, values, reason):
    good = {"alarm.shelf_time": 77.0, **values}
    before = predictor.get(*good)
    result = predictor.set(good)
    assert not result.successful
    assert reason in result.reason
    assert predictor.get(*good) == before
    both = {"alarm.time_warn": 9.0, "alarm.time_error": 4.0}  # each alone would be refused
    assert predictor.set(both).successful


def test_orbit_comes_to_who_subscribes(predictor):
    orbits: dict[int, PolygonStamped] = {}

    def keep(message: PolygonStamped) -> None:
        orbits[nanoseconds(message.header)] = message

    predictor.graph.collect(PolygonStamped, f"{predictor.name}/orbit", keep)
    predictor.graph.until(
        lambda: orbits, "an orbit comes", lambda: predictor.send(380.0, predictor.now())
    )
    stamp, message = max(orbits.items())
    points = [(point.x, point.y) for point in message.polygon.points]
    clearance = read_machine(PAPER_ROTOR).dampers[0].clearance
    eccentricity = numbers(predictor.eccentricity[stamp])["damper_1/max"]
    # a circle, as nothing but the unbalance acts
    radii = np.hypot(*np.transpose(points)) / clearance
    np.testing.assert_allclose(radii, eccentricity, rtol=1e-5)
    assert message.header.frame_id == "damper_1"


def test_orbits_come_five_times_a_second_and_the_newest_at_last(predictor):
    came: list[int] = []
    topic = f"{predictor.name}/orbit"
    predictor.graph.collect(
        PolygonStamped, topic, lambda one: came.append(nanoseconds(one.header))
    )
    predictor.graph.until(
        lambda: came, "an orbit comes", lambda: predictor.send(380.0, predictor.now())
    )
    came.clear()
    begin = time.monotonic()
    found = run(predictor, 3700.0, 3710.0, 4.0, part_predicted=0.0)
    predictor.graph.until(lambda: came and came[-1] >= found[-1].stamp, "the newest comes")
    assert len(came) <= 5.0 * (time.monotonic() - begin) + 1.0
    assert len(came) < len(found)


def test_the_speed_stands_beside_the_eccentricity(predictor):
    stamp = predictor.now()
    predictor.predict(380.0, stamp)
    message = predictor.eccentricity[stamp]
    assert list(message.velocity) == [380.0] * len(message.name)


def test_inactive_it_says_that_nothing_is_predicted(predictor):
    assert predictor.change_state("deactivate") == [True]
    values = predictor.until_warning(OK, "nothing is predicted, as the node is not active")
    assert values["margin_rpm"] == "nan"
    assert predictor.change_state("activate") == [True]
    predictor.until_warning(OK, "no speed has arrived yet")
