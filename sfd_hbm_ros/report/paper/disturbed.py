"""A disturbed response followed in time: what remains of the disturbance's harmonics."""

from dataclasses import replace

import numpy as np

from sfd_hbm_ros.hbm import HarmonicBalance, Solution
from sfd_hbm_ros.response.integration.integrator import Integrator
from sfd_hbm_ros.response.integration.ramp import Ramp
from sfd_hbm_ros.response.integration.transient import Transient, run


def third_harmonic(
    balance: HarmonicBalance, solution: Solution, disturbance: float, revolutions: tuple[int, int]
) -> tuple[float, float]:
    """Amplitude of 3x to that of 1x after so many and so many more revolutions.

    Parameters
    ----------
    balance : HarmonicBalance
        A machine with one damper.
    solution : Solution
        Its response, from which it is displaced at rotor angle 0.
    disturbance : float
        Displacement of the journal along x, of the clearance.
    revolutions : (int, int)
        Numbers of revolutions, at the response's speed.
    """
    integrator = Integrator(balance, solution.speed)
    state = integrator.start(solution)
    displacement = state.displacement.copy()
    displacement[integrator.rotor.journals[0, 0]] += disturbance * balance.clearances[0]
    state = replace(state, displacement=displacement)
    first, last = revolutions
    early = run(integrator, Ramp(solution.speed, 0.0, first), state)
    late = run(integrator, Ramp(solution.speed, 0.0, last), early.state)
    return _third(early), _third(late)


def _third(transient: Transient) -> float:
    """3x to 1x in the last revolution."""
    [orbit] = transient.orbit.values()
    amplitudes = np.linalg.norm(np.fft.rfft(orbit, axis=0), axis=1)
    return float(amplitudes[3] / amplitudes[1])
