"""The course of a branch between its points, near enough for Newton's method to end at once.

As a function of the parameter the response is steep beside a fold; over the arc of its branch it
is smooth. So between two points both the parameter and the coefficients are polynomials of the
arc, which pass through the two points and their neighbours.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm.bracketing import zero_between
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.response.curves.place import Place

Array = NDArray[np.float64]

_NEIGHBOURS = 2  # on either side
_BESIDE = (0.05, 20.0)  # distances of two neighbours that are of use, as parts of the stretch
_ACCURACY = 1e-12  # of an arc, as a part of the stretch


@dataclass(frozen=True, eq=False)
class Course:
    """A branch of periodic responses as a smooth line.

    Attributes
    ----------
    branch : CurveBranch
        The branch.
    """

    branch: CurveBranch

    def coefficients(self, place: Place) -> Array:
        """Coefficients at a place on the branch [m], (rows, n)."""
        polynomials = self._polynomials.get(place.index)
        if polynomials is None:
            polynomials = self._polynomials[place.index] = self._between(place.index)
        powers = _arc(polynomials[:, 0], place.value) ** np.arange(len(polynomials))
        found: Array = powers @ polynomials[:, 1:]
        return found.reshape(self.branch.solutions[place.index].coefficients.shape)

    def _between(self, index: int) -> Array:
        """Polynomials of the arc, which is 0 at a point and 1 at the next.

        Returns
        -------
        Factors of rising powers, the parameter's in the first column, then the coefficients'.
        """
        chords = np.diff(self._arcs) / (self._arcs[index + 1] - self._arcs[index])
        useful = (_BESIDE[0] < chords) & (chords < _BESIDE[1])
        first, last = index, index + 1
        while first > max(index - _NEIGHBOURS, 0) and useful[first - 1]:
            first -= 1
        while last < min(index + 1 + _NEIGHBOURS, len(chords)) and useful[last]:
            last += 1
        arcs = np.append(0.0, np.cumsum(chords[first:last]))
        powers = np.vander(arcs - arcs[index - first], increasing=True)
        return np.asarray(np.linalg.solve(powers, self._points[first : last + 1]), dtype=float)

    @cached_property
    def _points(self) -> Array:
        """The parameter and the coefficients of every point, (m, 1 + rows n)."""
        values, responses = self.branch.values, self.branch.solutions
        coefficients = np.array([one.coefficients.ravel() for one in responses])
        return np.column_stack([values, coefficients])

    @cached_property
    def _arcs(self) -> Array:
        """The arc from the first point to each, with coefficients and parameter scaled, (m,)."""
        journals = self.branch.solutions[0].journals.values()
        clearances = np.repeat([motion.clearance for motion in journals], 2)
        rows = (self._points.shape[1] - 1) // clearances.size
        scale = np.append(np.ptp(self.branch.values), np.tile(clearances, rows))
        chords = np.linalg.norm(np.diff(self._points / scale, axis=0), axis=1)
        return np.append(0.0, np.cumsum(chords))

    @cached_property
    def _polynomials(self) -> dict[int, Array]:
        return {}


def _arc(factors: Array, value: float) -> float:
    """The arc between 0 and 1 at which a polynomial has a value."""
    falling = factors[::-1].tolist()

    def beyond(arc: float) -> float:
        reached = 0.0
        for factor in falling:
            reached = reached * arc + factor
        return float(reached - value)

    first, last = beyond(0.0), beyond(1.0)
    if first * last >= 0.0:  # a point's own value, but for rounding
        return 0.0 if abs(first) < abs(last) else 1.0
    return zero_between(beyond, 0.0, 1.0, _ACCURACY)
