"""A journal's vibration by its orders of the speed."""

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from sfd_hbm_ros.hbm import JournalMotion

ComplexArray = NDArray[np.complex128]

FIRST = Fraction(1)
"""The order of the speed itself, 1x."""


def vibration(motion: JournalMotion) -> dict[Fraction, ComplexArray]:
    """Complex amplitudes by order: x and y are Re(Q exp(i order angle)).

    Parameters
    ----------
    motion : JournalMotion
        The motion.

    Returns
    -------
    dict of Fraction to (2,) complex array
        Q of x and y [m], zero to peak; that of order 0 is the mean.
    """
    amplitudes = motion.cos - 1j * motion.sin
    return {
        Fraction(multiple, motion.harmonics.revolutions): amplitude
        for multiple, amplitude in zip(motion.harmonics.multiples, amplitudes, strict=True)
    }
