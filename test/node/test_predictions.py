"""What the predictor publishes is what `solve` finds, whatever changes while it runs."""

import math
from dataclasses import replace

import pytest

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, Solution, solve
from sfd_hbm_ros.machine import Load, Machine, override, read_machine
from sfd_hbm_ros.response.tracking.measured import FLOOR

from .graph import Numbers, Remote
from .process import PAPER_ROTOR

PAPER = read_machine(PAPER_ROTOR)
OK, WARN, ERROR = b"\x00", b"\x01", b"\x02"


@pytest.fixture(scope="module")
def running(graph, start) -> Remote:
    start("-p", f"machine_file:={PAPER_ROTOR}", "-p", "stale_after:=60.0")
    remote = Remote(graph)
    remote.meet()
    return remote


@pytest.fixture
def predictor(running: Remote) -> Remote:
    """The predictor as after its start."""
    running.restart()
    assert running.set({"publish_rate": 1000.0, "harmonics": 7, "stale_after": 60.0}).successful
    return running


def solved(
    speed: float, machine: Machine = PAPER, k: int = 7, last: Solution | None = None
) -> Solution:
    solution = solve(HarmonicBalance(machine, Harmonics(k)), speed, last)
    assert solution.converged
    return solution


def check(prediction: tuple[Numbers, Numbers], solution: Solution) -> None:
    """Compare with what the solver returns, all of it."""
    eccentricity, harmonics = prediction
    journal = solution.journals["damper_1"]
    scale, c = abs(journal.coefficients).max(), journal.clearance
    assert eccentricity == pytest.approx(
        {
            "damper_1/max": journal.eccentricity_max,
            "damper_1/mean": journal.eccentricity_mean,
            "damper_1/static_x": journal.coefficients[0, 0] / c,
            "damper_1/static_y": journal.coefficients[0, 1] / c,
            "damper_1/other_branch/max": math.nan,
            "damper_1/measured/max": math.nan,
        },
        rel=1e-9,
        abs=1e-9 * scale / c,
        nan_ok=True,
    )
    expected = {}
    for column, axis in enumerate("xy"):
        expected[f"damper_1/{axis}/0x"] = journal.coefficients[0, column]
        for order in range(1, solution.harmonics.highest + 1):
            cos, sin = journal.coefficients[2 * order - 1 : 2 * order + 1, column]
            harmonic = f"damper_1/{axis}/{order}x"
            expected[f"{harmonic}/cos"], expected[f"{harmonic}/sin"] = cos, sin
    for name in [name for name in expected if name.endswith("/cos")]:
        sine = name.replace("/cos", "/sin")
        if math.isnan(harmonics[name.replace("/cos", "/phase")]):
            expected[name], expected[sine] = math.hypot(expected[name], expected[sine]), 0.0
    assert in_parts(harmonics) == pytest.approx(expected, rel=1e-9, abs=1e-9 * scale)


def in_parts(harmonics: Numbers) -> Numbers:
    """Turn A cos(i W t - phase) into cosine and sine."""
    parts = {name: value for name, value in harmonics.items() if name.endswith("/0x")}
    for name, amplitude in harmonics.items():
        harmonic, _, kind = name.rpartition("/")
        if kind == "amplitude":
            phase = harmonics[f"{harmonic}/phase"]
            if math.isnan(phase):  # where there is no vibration to have one
                assert amplitude < FLOOR * PAPER.dampers[0].clearance
                phase = 0.0
            parts[f"{harmonic}/cos"] = amplitude * math.cos(phase)
            parts[f"{harmonic}/sin"] = amplitude * math.sin(phase)
    return parts


def test_equals_solve_from_the_last_solution(predictor):
    last = None
    for speed in (200.0, 300.0, 400.0, 410.0, 640.0, 405.0):
        last = solved(speed, last=last)
        check(predictor.predict(speed), last)
    status = predictor.until_status("Solver", OK, "balance")
    assert status.hardware_id == "paper_rotor"


def test_load_and_gravity(predictor):
    predictor.predict(350.0)
    stamp = predictor.now()
    predictor.push("disk_3", (30.0, -200.0), stamp)
    loaded = replace(PAPER, loads=(Load("disk_3", (30.0, -200.0)),))
    check(predictor.answer(stamp), solved(350.0, loaded))
    assert predictor.set({"gravity": True}).successful
    both = override(loaded, "gravity", True)
    check(predictor.predict(360.0), solved(360.0, both))


def test_load_of_a_station_replaces_its_last_one(predictor):
    predictor.predict(350.0)
    stamps = [predictor.now() + i for i in range(3)]
    loads = [("disk_1", (0.0, -50.0)), ("disk_3", (0.0, -400.0)), ("disk_3", (0.0, -100.0))]
    for stamp, (station, force) in zip(stamps, loads, strict=True):
        predictor.push(station, force, stamp)
        answer = predictor.answer(stamp)
    last = replace(PAPER, loads=(Load("disk_1", (0.0, -50.0)), Load("disk_3", (0.0, -100.0))))
    check(answer, solved(350.0, last))


def test_load_that_nothing_can_carry_is_told_and_taken_back(predictor):
    predictor.predict(350.0)
    stamp = predictor.now()
    predictor.push("disk_3", (0.0, -1e5), stamp)
    eccentricity, harmonics = predictor.answer(stamp)
    assert all(math.isnan(value) for value in (*eccentricity.values(), *harmonics.values()))
    predictor.until_status("Solver", ERROR, "no solution was found within ")
    stamp = predictor.now()
    predictor.push("disk_3", (0.0, 0.0), stamp)
    check(predictor.answer(stamp), solved(350.0))


def test_load_at_an_unknown_station_is_refused(predictor):
    solution = solved(350.0)
    check(predictor.predict(350.0), solution)
    predictor.push("disk_9", (0.0, -100.0), predictor.now())
    status = predictor.until_status("Inputs", WARN, "disk_9")
    assert all(station in status.message for station in PAPER.stations)
    check(predictor.predict(350.0), solution)


def test_values_are_set_together_and_predicted_at_once(predictor):
    predictor.predict(400.0)
    changes = {
        "dampers.damper_1.viscosity": 0.014,
        "dampers.damper_1.centering_stiffness": 1751300,
        "unbalance.disk_2.magnitude": 2.0e-4,
        "unbalance.disk_2.phase": 0.5,
    }
    before = predictor.now()
    assert predictor.set(changes).successful
    stamp = predictor.graph.until(
        lambda: max(predictor.harmonics) > before and max(predictor.harmonics), "new prediction"
    )
    machine = PAPER
    for path, value in changes.items():
        machine = override(machine, path, value)
    check(predictor.answer(stamp), solved(400.0, machine))


@pytest.mark.parametrize(
    ("bad", "reason"),
    [
        ({"dampers.damper_1.viscosity": -0.01}, "dampers.damper_1.viscosity must be a finite"),
        ({"unbalance.disk_2.phase": math.nan}, "unbalance.disk_2.phase must be a finite"),
        ({"unbalance.disk_2.magnitude": "much"}, "unbalance.disk_2.magnitude must be a number"),
        ({"gravity": 1}, "gravity must be true or false, not 1"),
        ({"harmonics": 32}, "harmonics must be an integer from 1 to 31, not 32"),
        ({"publish_rate": 0.0}, "publish_rate must be a number from 0.1 to 1000 [Hz], not 0.0"),
        ({"publish_rate": [1.0, 2.0]}, "publish_rate must be a number"),
        ({"stale_after": math.inf}, "stale_after must be a number"),
        ({"dampers.damper_1.viscosty": 0.1}, "did you mean dampers.damper_1.viscosity?"),
        ({"machine_file": "other.yaml"}, "machine_file is fixed, as no machine_folder is set"),
        ({"autostart": False}, "autostart is fixed: it is read when the node starts"),
    ],
)
def test_values_are_refused_together_with_the_reason(predictor, bad, reason):
    good = {"frame_id": "other", "dampers.damper_1.centering_stiffness": 1.0e6}
    before = predictor.get(*good)
    solution = solved(400.0)
    check(predictor.predict(400.0), solution)
    result = predictor.set({**good, **bad})
    assert not result.successful
    assert reason in result.reason
    assert predictor.get(*good) == before
    check(predictor.predict(400.0), solution)


def test_harmonics_change_live(predictor):
    predictor.predict(400.0)
    assert predictor.set({"harmonics": 3, "frame_id": "casing"}).successful
    stamp = predictor.now()
    check(predictor.predict(400.0, stamp), solved(400.0, k=3))
    assert predictor.harmonics[stamp].header.frame_id == "casing"


def test_rotor_at_rest_and_unsolvable_speed_give_nan(predictor):
    for speed, level, reason in ((0.0, OK, "at rest"), (5e-324, ERROR, "gave up")):
        for published in predictor.predict(speed):
            assert published
            assert all(math.isnan(value) for value in published.values())
        predictor.until_status("Solver", level, reason)
    check(predictor.predict(300.0), solved(300.0))
    predictor.until_status("Solver", OK, "balance")


def test_rate_limit_keeps_the_newest(predictor):
    rate = 2.0
    assert predictor.set({"publish_rate": rate}).successful
    predictor.harmonics.clear()
    stamps = [predictor.now() + i for i in range(10)]
    start = predictor.now()
    for i, stamp in enumerate(stamps):
        predictor.send(300.0 + i, stamp)
        predictor.beats(1)
    check(predictor.answer(stamps[-1]), solved(309.0))
    seconds = (predictor.now() - start) * 1e-9
    assert len(predictor.harmonics) <= 1 + rate * seconds


def test_stale_speed_ends_the_predictions_but_not_the_heartbeat(predictor):
    predictor.predict(300.0)
    assert predictor.set({"stale_after": 0.3}).successful
    predictor.until_status("Inputs", ERROR, "stale")
    count = len(predictor.harmonics)
    assert predictor.set({"gravity": True}).successful
    predictor.push("disk_3", (0.0, -100.0), predictor.now())
    predictor.beats()
    assert len(predictor.harmonics) == count
    predictor.predict(300.0)


def test_states(predictor):
    assert predictor.state() == "active"
    assert predictor.change_state("activate", "no such transition") == [False, False]
    assert predictor.change_state("deactivate") == [True]
    predictor.until_status("Model", OK, "inactive")
    count = len(predictor.harmonics)
    predictor.send(300.0, predictor.now())
    predictor.beats()
    assert len(predictor.harmonics) == count
    assert predictor.change_state("activate") == [True]
    predictor.until_status("Inputs", WARN, "waiting for the first message on /predictor/speed")
    check(predictor.predict(300.0), solved(300.0))
    assert predictor.change_state("deactivate", "cleanup") == [True, True]
    predictor.until_status("Model", OK, "unconfigured")
    assert not predictor.set({"gravity": True}).successful
    predictor.push("disk_3", (0.0, -100.0), predictor.now())
    predictor.until_status("Inputs", WARN, "there is no machine yet")
    assert predictor.change_state("configure", "activate") == [True, True]
    check(predictor.predict(300.0), solved(300.0))
