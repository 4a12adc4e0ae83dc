"""Checks of the solver against closed forms and the reference paper, done a slice at a time."""

from __future__ import annotations

import math
from collections.abc import Generator, Iterator
from dataclasses import dataclass

import numpy as np

from sfd_hbm_ros.film import film_of
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.hbm.continuation import Branch
from sfd_hbm_ros.hbm.family import SpeedFamily
from sfd_hbm_ros.hbm.options import ContinuationOptions
from sfd_hbm_ros.machine import Damper, Machine, override_all
from sfd_hbm_ros.units import RPM

_EXACT = 1e-9  # relative, to which closed forms hold where nothing is iterated
_SOLVED = 1e-8  # of the clearance, to which closed forms hold for solutions
_PAPER = "of the paper's"
_COARSE = ContinuationOptions(longest_step=0.12, eccentricity=0.98)


@dataclass(frozen=True)
class PublishedPeak:
    """A critical speed that somebody has published.

    Attributes
    ----------
    machine : Machine
        The machine.
    speeds_rpm : (float, float)
        Range in which it is looked for [rpm].
    rpm : float
        The speed of the peak [rpm].
    within : float
        Part of it within which another agrees.
    source : str
        Where it stands.
    """

    machine: Machine
    speeds_rpm: tuple[float, float]
    rpm: float
    within: float
    source: str


@dataclass(frozen=True)
class PublishedJumps:
    """A hysteresis that somebody has published.

    Attributes
    ----------
    machine : Machine
        The machine.
    speeds_rpm : (float, float)
        Range in which the jumps of start-up and coast-down are looked for [rpm].
    between_rpm : (float, float)
        Speeds between which both lie [rpm].
    width_rpm : float
        How far they are apart [rpm].
    speed_within, width_within : float
        Parts of these within which others agree.
    source : str
        Where it stands.
    """

    machine: Machine
    speeds_rpm: tuple[float, float]
    between_rpm: tuple[float, float]
    width_rpm: float
    speed_within: float
    width_within: float
    source: str


@dataclass(frozen=True)
class Finding:
    """How far a result lies from the truth.

    Attributes
    ----------
    name : str
        What was checked.
    source : str
        Where the truth stands.
    deviation : float
        The greatest difference from it.
    limit : float
        Deviation up to which the check is passed.
    unit : str
        Unit of both.
    """

    name: str
    source: str
    deviation: float
    limit: float
    unit: str

    @property
    def passed(self) -> bool:
        """Whether the deviation is within its limit; NaN is not."""
        return self.deviation <= self.limit


def self_test(
    machine: Machine, peak: PublishedPeak, jumps: PublishedJumps
) -> Iterator[Finding | None]:
    """Check the solver on the paper's rotor.

    Parameters
    ----------
    machine : Machine
        The rotor of the reference paper as its machine file has it, with one damper.
    peak, jumps : PublishedPeak, PublishedJumps
        What the paper has computed of variants of it.

    Yields
    ------
    Finding or None
        The outcome of each check; None wherever a caller in a hurry may pause.
    """
    pi_film = override_all(
        machine, {"dampers.damper_1.film.inertia": False, "dampers.damper_1.film.cavitation": True}
    )
    yield _film(pi_film.dampers[0])
    yield _circular_orbit(pi_film)
    yield from _peak(peak)
    yield from _jumps(jumps)


def _film(damper: Damper) -> Finding:
    """The film's force on circular orbits about the centre."""
    film, speed, worst = film_of(damper), 400.0, 0.0
    for eccentricity in (0.1, 0.5, 0.9):
        r = eccentricity * damper.clearance
        position, velocity = np.array([[r, 0.0]]), np.array([[0.0, speed * r]])
        force = film.force(position, velocity, -(speed**2) * position)[0]
        expected = -_film_stiffness(damper, eccentricity, speed) * r
        worst = max(worst, abs(complex(*force) - expected) / abs(expected))
    source = "Gunter, Barrett and Allaire 1977, J. Lubr. Technol. 99, 57"
    return Finding("film force on circular orbits", source, worst, _EXACT, "of the force")


def _film_stiffness(damper: Damper, e: float, speed: float) -> complex:
    """K + i W C of the short pi film on a circular orbit of eccentricity e [N/m]."""
    viscous = damper.viscosity * 0.5 * damper.diameter * (damper.length / damper.clearance) ** 3
    s = 1.0 - e**2
    return viscous * speed * complex(2.0 * e / s**2, 0.5 * math.pi / s**1.5)


def _circular_orbit(machine: Machine) -> Finding:
    """The response of an axisymmetric rotor whose unbalance was chosen for its eccentricity."""
    [damper], speed, e = machine.dampers, 300.0, 0.3
    balance = HarmonicBalance(machine, Harmonics(3))
    model = balance.model
    dynamic = model.K - speed**2 * model.M + 1j * speed * (model.C + speed * model.G)
    forward = dynamic[::2, ::2] - 1j * dynamic[::2, 1::2]  # of x + i y = z exp(i W t)
    journal = model.journals[0, 0] // 2
    unit = np.eye(len(forward))[journal]
    by_unbalance, by_film = np.linalg.solve(
        forward, np.column_stack([speed**2 * model.unbalance[::2], unit])
    )[journal]
    drive = e * damper.clearance * (1.0 + by_film * _film_stiffness(damper, e, speed))
    times = abs(drive / by_unbalance)
    z = e * damper.clearance * times * by_unbalance / drive
    [unbalance] = machine.unbalance
    magnitude = {f"{unbalance.where}.magnitude": times * unbalance.magnitude}
    solution = solve(HarmonicBalance(override_all(machine, magnitude), Harmonics(3)), speed)
    expected = np.zeros_like(solution.coefficients)
    expected[1:3] = [[z.real, z.imag], [-z.imag, z.real]]
    worst = float(np.abs(solution.coefficients - expected).max()) / damper.clearance
    source = "the same film with the rotor's full matrices: one complex equation"
    return Finding("circular response of the rotor", source, worst, _SOLVED, "of the clearance")


def _peak(published: PublishedPeak) -> Iterator[Finding | None]:
    """The speed at which the response of a variant is greatest."""
    points: list[tuple[float, float]] = []
    for point in _branch(published.machine, *published.speeds_rpm):
        yield None
        points.append(point)
    deviation = abs(_top(points) / published.rpm - 1.0)
    source = f"{published.source}: {published.rpm:g} rpm"
    yield Finding("speed of a peak", source, deviation, published.within, _PAPER)


def _top(points: list[tuple[float, float]]) -> float:
    """Abscissa of the parabola through the highest of some points and its neighbours.

    NaN where none of them lies between others.
    """
    heights = [height for _, height in points]
    top = int(np.argmax(heights)) if points else 0
    if not 0 < top < len(points) - 1:
        return math.nan
    x, y = zip(*points[top - 1 : top + 2], strict=True)
    curvature, slope, _ = np.polyfit(np.array(x) - x[1], y, 2)
    return float(x[1] - 0.5 * slope / curvature)


def _jumps(published: PublishedJumps) -> Iterator[Finding | None]:
    """The speeds at which a variant jumps during start-up and coast-down."""
    low, high = published.speeds_rpm
    start_up = yield from _jump(published.machine, low, high)
    coast_down = yield from _jump(published.machine, high, low)
    least, most = published.between_rpm
    outside = max(0.0, least / coast_down - 1.0, start_up / most - 1.0)
    if math.isnan(start_up + coast_down):
        outside = math.nan
    source = f"{published.source}: between {least:g} and {most:g} rpm"
    yield Finding("speeds of jumps", source, outside, published.speed_within, _PAPER)
    deviation = abs((start_up - coast_down) / published.width_rpm - 1.0)
    source = f"{published.source}: {published.width_rpm:g} rpm apart"
    yield Finding("width of a hysteresis", source, deviation, published.width_within, _PAPER)


def _jump(machine: Machine, start: float, end: float) -> Generator[None, None, float]:
    """The speed [rpm] at which a branch turns back or closes; NaN where it leads to the end."""
    rpm = math.nan
    for rpm, _ in _branch(machine, start, end):  # noqa: B007 - the last one is wanted
        yield
    return math.nan if math.isclose(rpm, end) else rpm


def _branch(machine: Machine, start: float, end: float) -> Iterator[tuple[float, float]]:
    """Speeds [rpm] and eccentricities along a branch, up to where it turns back or closes."""
    balance = HarmonicBalance(machine, Harmonics(1))
    first = solve(balance, start * RPM)
    branch = Branch(
        SpeedFamily(balance),
        first.coefficients.ravel(),
        start * RPM,
        end * RPM,
        options=_COARSE,
    )
    for point in branch:
        if (end - start) * point.tangent[-1] <= 0.0:
            return
        yield float(point.value / RPM), point.eccentricity
