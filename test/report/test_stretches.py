"""Branches cut into stable and unstable stretches."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sfd_hbm_ros.hbm import Instability
from sfd_hbm_ros.report.stretches import losses, stretches

from .curves import made, motion

#: Letters for points: stable, a fold, and unstable in each way.
KINDS = {
    "s": None,
    "F": Instability.FOLD,
    "f": Instability.FOLD,
    "n": Instability.NEIMARK_SACKER,
    "p": Instability.PERIOD_DOUBLING,
}
CIRCLE = motion(np.array([[0.0, 0.0], [1e-5, 0.0], [0.0, 1e-5]]))


def branch(letters):
    curve = made(
        np.arange(1.0, len(letters) + 1.0),
        [CIRCLE] * len(letters),
        tuple(KINDS[letter] for letter in letters),
        np.array([letter == "F" for letter in letters]),
    )
    return curve.branches[0]


@pytest.mark.parametrize(
    ("letters", "expected"),
    [
        ("s", []),
        ("sss", [(0, 2, True)]),
        ("nn", [(0, 1, False)]),
        ("ssFffFss", [(0, 2, True), (2, 5, False), (5, 7, True)]),
        ("sFFs", [(0, 1, True), (1, 2, False), (2, 3, True)]),  # folds next to each other
        ("ssnns", [(0, 2, True), (2, 3, False), (3, 4, True)]),
        ("ssnnnnss", [(0, 2, True), (2, 5, False), (5, 7, True)]),
        ("sspss", [(0, 4, True)]),  # stability is touched, not lost
        ("ssnFns", [(0, 2, True), (2, 4, False), (4, 5, True)]),  # a fold between unstable points
    ],
)
def test_stretches(letters, expected):
    found = [
        (one.points.start, one.points.stop - 1, one.stable) for one in stretches(branch(letters))
    ]
    assert found == expected


@pytest.mark.parametrize(
    ("letters", "expected"),
    [
        ("sss", []),
        ("ssFfFs", [(2, "fold"), (4, "fold")]),
        ("ssnnns", [(2, "Neimark-Sacker"), (4, "Neimark-Sacker")]),
        ("pps", [(1, "period doubling")]),
        ("snn", [(1, "Neimark-Sacker")]),
        ("sspss", [(2, "period doubling")]),
        ("sFnns", [(1, "fold"), (3, "Neimark-Sacker")]),
    ],
)
def test_losses(letters, expected):
    assert [(i, kind.value) for i, kind in losses(branch(letters))] == expected


@given(st.text("sFfnp", min_size=2, max_size=12))
def test_stretches_cover_a_branch(letters):
    """Every arc once, stable ones with a stable point at an end and a change at most at one."""
    cut = branch(letters)
    found = stretches(cut)
    arcs = [i for one in found for i in range(one.points.start, one.points.stop - 1)]
    assert arcs == list(range(len(letters) - 1))
    assert all(one.stable is not two.stable for one, two in pairwise(found))
    for one in found:
        if one.stable:
            assert all("s" in arc and "f" not in arc for arc in pairwise(letters[one.points]))
