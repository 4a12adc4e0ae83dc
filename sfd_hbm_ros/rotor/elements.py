"""The Timoshenko beam element of a shaft, in one lateral plane.

Its freedoms are the deflection and the rotation of the cross-section at either end, (v1, r1, v2,
r2); where shear is small the rotation is the slope dv/dz. The shape functions solve the static
Timoshenko beam exactly, as in Nelson, "A finite rotating shaft element using Timoshenko beam
theory", J. Mech. Des. 102 (1980), and Friswell et al., "Dynamics of Rotating Machines" (2010),
section 5.4. The shaft is axisymmetric, so one element serves both lateral planes. Frequencies
converge with the fourth power of the length of the elements where shear is small, else with the
second.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg import hilbert

from sfd_hbm_ros.machine import ShaftSegment
from sfd_hbm_ros.rotor.arrays import RealArray

_MOMENTS = hilbert(4)
"""Integrals of z^i z^j over z = 0 to 1."""


@dataclass(frozen=True, eq=False)
class BeamElement:
    """Matrices of one element, for its freedoms (v1, r1, v2, r2) in one plane.

    Parameters
    ----------
    mass : (4, 4) array
        Consistent mass with rotary inertia [kg, kg m, kg m2].
    gyroscopic : (4, 4) array
        Polar inertia of the turning cross-sections [kg, kg m, kg m2]. It couples the planes:
        see `sfd_hbm_ros.rotor.parts`.
    stiffness : (4, 4) array
        Bending and shear stiffness [N/m, N, N m].
    """

    mass: RealArray
    gyroscopic: RealArray
    stiffness: RealArray


def shear_coefficient(poisson_ratio: float, diameter_ratio: float) -> float:
    """Return Cowper's shear coefficient of a hollow circular section.

    Parameters
    ----------
    poisson_ratio : float
        Poisson's ratio of the material.
    diameter_ratio : float
        Inner over outer diameter, 0 for a solid shaft.

    Returns
    -------
    float
        Share of the section's area that carries shear.

    Notes
    -----
    Cowper, "The shear coefficient in Timoshenko's beam theory", J. Appl. Mech. 33 (1966).
    """
    nu, m2 = poisson_ratio, diameter_ratio**2
    return (
        6.0
        * (1.0 + nu)
        * (1.0 + m2) ** 2
        / ((7.0 + 6.0 * nu) * (1.0 + m2) ** 2 + (20.0 + 12.0 * nu) * m2)
    )


def beam_element(segment: ShaftSegment) -> BeamElement:
    """Return the matrices of one of the equal elements of a shaft segment.

    Parameters
    ----------
    segment : ShaftSegment
        Its `length` is that of one element.

    Returns
    -------
    BeamElement
        The element's matrices, integrated exactly.
    """
    material, length = segment.material, segment.length
    outer, inner = segment.outer_diameter, segment.inner_diameter
    area = math.pi / 4.0 * (outer**2 - inner**2)
    second_moment = math.pi / 64.0 * (outer**4 - inner**4)
    shear_modulus = material.youngs_modulus / (2.0 * (1.0 + material.poisson_ratio))

    bending = material.youngs_modulus * second_moment
    shear = shear_coefficient(material.poisson_ratio, inner / outer) * shear_modulus * area
    deflection, rotation = _shapes(12.0 * bending / (shear * length**2), length)
    curvature = _derivative(rotation) / length
    shear_angle = _derivative(deflection) / length - rotation

    linear_density = material.density * area
    rotary_inertia = material.density * second_moment * length * _product(rotation)
    return BeamElement(
        mass=linear_density * length * _product(deflection) + rotary_inertia,
        gyroscopic=2.0 * rotary_inertia,
        stiffness=length * (bending * _product(curvature) + shear * _product(shear_angle)),
    )


def _shapes(phi: float, length: float) -> tuple[RealArray, RealArray]:
    """Return deflection and rotation of the four unit freedoms over z/length, as polynomials.

    Rows are freedoms, columns the coefficients of rising powers; `phi` is the ratio of shear to
    bending flexibility, 12 E I / (kappa G A length^2).
    """
    deflection = [
        [1.0 + phi, -phi, -3.0, 2.0],
        [0.0, (1.0 + phi / 2.0) * length, -(2.0 + phi / 2.0) * length, length],
        [0.0, phi, 3.0, -2.0],
        [0.0, -phi / 2.0 * length, -(1.0 - phi / 2.0) * length, length],
    ]
    rotation = [
        [0.0, -6.0 / length, 6.0 / length, 0.0],
        [1.0 + phi, -(4.0 + phi), 3.0, 0.0],
        [0.0, 6.0 / length, -6.0 / length, 0.0],
        [0.0, -(2.0 - phi), 3.0, 0.0],
    ]
    return np.array(deflection) / (1.0 + phi), np.array(rotation) / (1.0 + phi)


def _derivative(polynomials: RealArray) -> RealArray:
    """Differentiate polynomials given by rows of coefficients of rising powers."""
    lowered = np.zeros_like(polynomials)
    lowered[:, :-1] = polynomials[:, 1:] * np.arange(1.0, polynomials.shape[1])
    return lowered


def _product(polynomials: RealArray) -> RealArray:
    """Integrate the product of every two polynomials from 0 to 1, symmetric to the last digit."""
    product = polynomials @ _MOMENTS @ polynomials.T
    return np.asarray(0.5 * (product + product.T))
