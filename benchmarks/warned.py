"""How well jumps are warned of: random run-ups and coast-downs of random machines.

Whether a machine jumps, and when, is taken from the time integration; the warning from the
response curve and from noisy speeds. A jump counts as warned of where the warning was raised the
configured time before it, and is called gone where it fell again before the machine jumped, which
does so later than the curve says the faster its speed changes. Chatter is a warning that was
raised more than once before the jump. Where the machine does not jump, any warning is false.

    python3 -m benchmarks.warned --runs 200
    python3 -m benchmarks.warned --first 17 --runs 1
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from benchmarks.warned_in_time import jump_in_time
from benchmarks.warned_run import Run, random_run
from sfd_hbm_ros.response.curves.journey import travel
from sfd_hbm_ros.response.curves.place import Place
from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.response.integration.observed import LEAST
from sfd_hbm_ros.response.tracking.excursion import Excursion
from sfd_hbm_ros.response.warning.acceleration import AccelerationEstimator
from sfd_hbm_ros.response.warning.jump_alarm import JumpAlarm
from sfd_hbm_ros.response.warning.jump_map import jump_map
from sfd_hbm_ros.response.warning.outlook import unknown_outlook
from sfd_hbm_ros.response.warning.settings import AlarmSettings, Level

AHEAD = 2.0  # s by which a jump is to be warned of
RATE, NOISE = 50.0, 0.05  # of the speeds: Hz, rad/s
SETTINGS = AlarmSettings(
    margin_warn_rpm=0.0,
    margin_error_rpm=0.0,
    time_warn=AHEAD + 0.5,  # what the on-delay and the noise take is to be on top
    time_error=0.0,
    eccentricity_warn=0.0,
    eccentricity_error=0.0,
    on_delay=0.1,
    off_delay=1.0,
)
WRONG = "missed", "chatter", "false warning"


class Outcome(NamedTuple):
    """What became of one run.

    Attributes
    ----------
    verdict : str
        What it counts as, or why it could not be judged.
    about : str
        The run, in words.
    """

    verdict: str
    about: str = ""


def warnings(case: Run, until: float, rng: np.random.Generator, wrong: float = 0.0) -> list[float]:
    """When the warning rose and fell in turns [s], as noisy speeds came in until a time [s].

    A part `wrong` of the speeds is measured as half or twice what they are.
    """
    estimator, alarm, ahead = AccelerationEstimator(), JumpAlarm(SETTINGS), jump_map(case.curve)
    place: Place | None = case.place
    excursion = Excursion[bool]()
    found: list[float] = []
    for now in np.arange(0.0, until, 1.0 / RATE).tolist():
        speed = case.ramp.start + case.ramp.acceleration * now + rng.normal(0.0, NOISE)
        speed *= slip(rng, wrong)
        estimator.add(round(now * 1e9), speed)
        excursion.returned(speed, now, known=True)
        if excursion.away:  # as the predictor does, which believes no such speed at once
            continue
        place = travel(case.curve, place, speed).place if place else None
        course = estimator.acceleration, estimator.settled
        outlook = ahead.outlook(place, *course) if place else unknown_outlook(speed, course[0])
        alarm.update(outlook, place.eccentricity if place else np.nan, now)
        if (alarm.level(now) is Level.WARN) != len(found) % 2:
            found.append(now)
    return found


def slip(rng: np.random.Generator, wrong: float) -> float:
    """What a measured speed is multiplied by: half or twice in a part `wrong` of all cases."""
    if wrong == 0.0 or rng.random() >= wrong:
        return 1.0
    return float(rng.choice([0.5, 2.0]))


def judge(rng: np.random.Generator, wrong: float = 0.0) -> Outcome:
    """Run a machine and see what became of it."""
    try:
        case = random_run(rng)
        jump = jump_in_time(case)
    except NoSolutionError as error:
        return Outcome(f"not judged: {error}")
    return outcome(case, jump, warnings(case, min(jump, case.duration), rng, wrong))


def outcome(case: Run, jump: float, changes: Sequence[float]) -> Outcome:
    """What became of a run.

    Parameters
    ----------
    case : Run
        The run.
    jump : float
        When the machine jumped [s]; infinite if it did not.
    changes : sequence of float
        When the warning rose and fell in turns [s], before the jump or the end.
    """
    about = f"{case.ramp.start:6.1f} rad/s {case.ramp.acceleration:+6.2f} rad/s2"
    if np.isfinite(case.fold):
        about += f", fold after {case.time(case.fold):5.2f} s by {case.change:+.2f}"
    about += f", jump after {jump:5.2f} s" if np.isfinite(jump) else ", no jump"
    if changes:
        about += ", warning " + ", ".join(f"{one:.2f}" for one in changes)
    if np.isinf(jump) and np.isfinite(case.fold) and not abs(case.change) >= LEAST:
        slight = np.isfinite(case.change)
        return Outcome(f"not judged: {'too slight a' if slight else 'unknown'} jump", about)
    if np.isinf(jump):
        return Outcome("false warning" if changes else "rightly silent", about)
    if len(changes) > 2:
        return Outcome("chatter", about)
    if not (changes and jump - changes[0] >= AHEAD):
        return Outcome("missed", about)
    return Outcome("warned" if len(changes) == 1 else "warned, gone", about)


def score(counts: Counter[str]) -> Iterator[str]:
    """Yield the lines of the result."""
    for verdict, count in counts.most_common():
        yield f"{count:5} {verdict}"
    warned = counts["warned"] + counts["warned, gone"]
    jumps = warned + counts["missed"] + counts["chatter"]
    if jumps:
        share = 100.0 * warned / jumps
        yield f"{jumps} jumps, {share:.1f} % of them warned of at least {AHEAD:g} s ahead"
    quiet = counts["rightly silent"] + counts["false warning"]
    yield f"{quiet} runs without a jump, {counts['false warning']} of them with a warning"


def arguments(about: str, runs: int) -> argparse.Namespace:
    """What the command line asks for; a number that is not allowed is refused."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--runs", type=int, default=runs, help="how many runs")
    parser.add_argument("--first", type=int, default=1, help="number of the first")
    parser.add_argument("--seed", type=int, default=1, help="of all of them")
    parser.add_argument(
        "--wrong-speeds", type=float, default=0.0, help="part measured as half or twice"
    )
    parser.add_argument(
        "--load-noise",
        type=float,
        default=0.0,
        help="rms of a load of mean 0 at the first station, 10 Hz [N]; through the node only",
    )
    given = parser.parse_args()
    if not 0.0 <= given.wrong_speeds < 0.5:
        parser.error(f"--wrong-speeds: {given.wrong_speeds} is not allowed, it must be below 0.5")
    if not 0.0 <= given.load_noise < np.inf:
        parser.error(f"--load-noise: {given.load_noise} N is not allowed, it must be finite")
    for name, least in (("runs", 1), ("first", 0), ("seed", 0)):
        if getattr(given, name) < least:
            parser.error(f"--{name}: {getattr(given, name)} is not allowed, at least {least} is")
    return given


def main() -> int:
    """Run and print; the exit code is 1 where a run was missed, chattered or wrongly warned."""
    given = arguments(__doc__.partition("\n")[0], runs=200)
    counts = Counter[str]()
    last = given.first + given.runs - 1
    for number in range(given.first, last + 1):
        begin = time.process_time()
        rng = np.random.default_rng([given.seed, number])
        verdict, about = judge(rng, given.wrong_speeds)
        counts[verdict] += 1
        took = time.process_time() - begin
        print(f"{number:4} of {last}  {verdict:14}  {about}  ({took:.0f} s)", flush=True)
    print("\n".join(score(counts)))
    return int(any(counts[verdict] for verdict in WRONG))


if __name__ == "__main__":
    raise SystemExit(main())
