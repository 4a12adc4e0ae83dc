"""What the claims read off the computed curves: peaks, responses at a speed, summaries."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

from scipy.optimize import minimize_scalar

from sfd_hbm_ros.hbm import JournalMotion, Solution, solve
from sfd_hbm_ros.report.paper.cases import Numbers, Range
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.curves.place import solutions_at
from sfd_hbm_ros.response.curves.summary import Summary
from sfd_hbm_ros.units import RPM

_ACCURACY = 0.02 * RPM  # to which the speed of a peak is found [rad/s]

Measure = Callable[[Solution], float]


def eccentricity(solution: Solution) -> float:
    """Greatest eccentricity of the orbit from the centre (Eq. 15)."""
    return solution.eccentricity_max


def vibration(solution: Solution) -> float:
    """Greatest distance of the orbit from its own mean, of the clearance."""
    motion = journal(solution)
    return motion.vibration / motion.clearance


def journal(solution: Solution) -> JournalMotion:
    """Motion of the only damper's journal."""
    [motion] = solution.journals.values()
    return motion


@dataclass(frozen=True)
class Peak:
    """A critical speed [rpm], and the amplitude there."""

    rpm: float
    amplitude: float


@dataclass(frozen=True, eq=False)
class Study:
    """The computed cases.

    Attributes
    ----------
    computed : mapping of str to ResponseCurve
        The cases' curves by their names.
    agreement : mapping of str to float
        Within what numbers agree with the paper's, by their kind.
    criticals_rpm : (float, float)
        Range of the speed in which the first critical speed lies [rpm].
    """

    computed: Mapping[str, ResponseCurve]
    agreement: Numbers
    criticals_rpm: Range

    def curve(self, name: str) -> ResponseCurve:
        """Response curve of a case."""
        return self.computed[name]

    def summary(self, name: str) -> Summary:
        """Folds and jumps of a case."""
        return Summary(self.curve(name))

    @cache  # noqa: B019 - a study lives as long as the program
    def peak(self, name: str, measure: Measure = eccentricity) -> Peak | None:
        """The highest stable maximum of an amplitude about the first critical speed, if any."""
        curve = self.curve(name)
        low, high = self.criticals_rpm
        peaks = [
            _refined(curve, branch, i, measure)
            for branch in curve.branches
            for i in _maxima(branch, measure)
            if low <= branch.speed[i] / RPM <= high
        ]
        return max(peaks, key=lambda peak: peak.amplitude, default=None)

    def peaks(self, names: Sequence[str], measure: Measure = eccentricity) -> list[Peak]:
        """The peaks of several cases that all have one."""
        found = [self.peak(name, measure) for name in names]
        return [peak for peak in found if peak is not None]

    def start_up(self, name: str, rpm: float) -> Solution:
        """Response at a speed that a run-up meets: the first along the arc."""
        curve = self.curve(name)
        _, solution = next(solutions_at(curve.branches[0], rpm * RPM))
        assert isinstance(solution, Solution)  # as the first branch of every curve has them
        return solution

    def amplitudes(
        self, names: Sequence[str], rpm: float, measure: Measure = eccentricity
    ) -> list[float]:
        """Amplitudes of several cases at a speed, during start-up."""
        return [measure(self.start_up(name, rpm)) for name in names]


def _maxima(branch: CurveBranch, measure: Measure) -> Iterator[int]:
    """Stable points that are higher than their neighbours."""
    heights = [measure(solution) for solution in branch.orbits]
    for i in range(1, len(heights) - 1):
        if branch.stable[i] and heights[i - 1] < heights[i] > heights[i + 1]:
            yield i


def _refined(curve: ResponseCurve, branch: CurveBranch, i: int, measure: Measure) -> Peak:
    """The maximum near a point, between its neighbours."""
    start = branch.orbits[i]

    def depth(speed: float) -> float:
        solution = solve(curve.balance, speed, start)
        return -measure(solution) if solution.converged else 0.0

    found = minimize_scalar(
        depth,
        bounds=sorted((branch.values[i - 1], branch.values[i + 1])),
        method="bounded",
        options={"xatol": _ACCURACY},
    )
    return Peak(float(found.x) / RPM, -float(found.fun))
