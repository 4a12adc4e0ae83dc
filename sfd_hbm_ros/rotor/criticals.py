"""Critical speeds of the rotor on its bearings and centring springs, films left out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eig

from sfd_hbm_ros.rotor.directions import Direction, direction, senses
from sfd_hbm_ros.rotor.model import RotorModel
from sfd_hbm_ros.rotor.modes import HELD, SHIFT


@dataclass(frozen=True)
class CriticalSpeed:
    """A speed at which a mode of the undamped rotor whirls just as fast as the rotor turns.

    Parameters
    ----------
    speed : float
        Rotor speed [rad/s].
    direction : Direction
        Sense of the mode's orbits. The unbalance of an axisymmetric rotor excites forward modes.
    """

    speed: float
    direction: Direction


def critical_speeds(model: RotorModel) -> list[CriticalSpeed]:
    """Return the critical speeds up to ten times the first, in rising order.

    A whirl exp(i W t) at the speed W obeys (K - W^2 (M - i G)) q = 0, which is linear in W^2.
    Damping is left out, and so is what differs between the cross-coupled stiffnesses xy and yx of
    a bearing, since that too feeds or drains a whirl.

    Parameters
    ----------
    model : RotorModel
        The rotor.

    Returns
    -------
    list of CriticalSpeed
        The critical speeds, forward, backward and planar.
    """
    stiffness = (model.K + model.K.T) / 2.0
    inertia = model.M - 1j * model.G
    # Each eigenvalue is 1 / (W^2 + SHIFT^2). It is negative for a forward mode that polar inertia
    # stiffens more than mass softens it: such a mode outruns the speed for ever.
    eigenvalues, shapes = eig(np.linalg.solve(stiffness + SHIFT**2 * inertia, inertia))
    sense = senses(model.M, shapes)
    squares = 1.0 / eigenvalues.real - SHIFT**2
    criticals = [
        CriticalSpeed(float(np.sqrt(squares[i])), direction(sense[i]))
        for i in np.argsort(squares)
        if squares[i] > HELD**2
    ]
    return [critical for critical in criticals if critical.speed <= 10.0 * criticals[0].speed]
