"""A response curve as a table of numbers."""

from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

from sfd_hbm_ros.hbm import Harmonics, Solution
from sfd_hbm_ros.report.abscissa import Abscissa
from sfd_hbm_ros.report.csv_file import write_csv
from sfd_hbm_ros.response.curves.curve import ResponseCurve
from sfd_hbm_ros.response.responses import Response
from sfd_hbm_ros.units import RPM


def write_table(curve: ResponseCurve, path: str | Path) -> None:
    """Write a curve as CSV: one row a point, branch by branch in the order of the arc.

    Columns are the speed [rpm], the entry of the machine file if one varies, whether the point is
    stable (1 or 0), and of each damper the greatest eccentricity and the coefficients of Eq. 2
    [m]: mean, then cosine and sine of each order, of x and then of y; at last the orders in use,
    the branch by its number from 0, the detached ones behind the others, and of a quasi-periodic
    response its second frequency, in the frame that turns with the rotor, over the speed. Such a
    response has no orders of the speed, and these and the coefficients are empty; other responses
    leave the frequency empty. Numbers are written in full precision.

    Parameters
    ----------
    curve : ResponseCurve
        The curve.
    path : str or Path
        The file.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    write_csv(path, _header(curve), _rows(curve))


def _header(curve: ResponseCurve) -> list[str]:
    harmonics = curve.harmonics
    orders = [Fraction(multiple, harmonics.revolutions) for multiple in harmonics.multiples]
    waves = [f"{order}_{wave}" for order in orders[1:] for wave in ("cos", "sin")]
    coefficients = [f"{axis}_{wave}" for axis in "xy" for wave in ("0", *waves)]
    varied = Abscissa.of(curve).path
    return [
        "speed_rpm",
        *([] if varied is None else [varied]),
        "stable",
        *(
            f"{damper}.{column}"
            for damper in curve.dampers
            for column in ("eccentricity_max", *coefficients)
        ),
        "orders",
        "branch",
        "frequency_ratio",
    ]


def _rows(curve: ResponseCurve) -> Iterator[list[float | str]]:
    varied = Abscissa.of(curve).path
    for number, branch in enumerate(curve.every_branch):
        for value, response, stable in zip(
            branch.values.tolist(), branch.solutions, branch.stable, strict=True
        ):
            row: list[float | str] = [
                response.speed / RPM,
                *([] if varied is None else [value]),
                int(stable),
            ]
            for damper in curve.dampers:
                row.append(response.journals[damper].eccentricity_max)
                row += _coefficients(curve.harmonics, response, damper)
            if isinstance(response, Solution):
                yield [*row, " ".join(map(str, response.orders)), number, ""]
            else:
                yield [*row, "", number, response.frequency_ratio]


def _coefficients(
    harmonics: Harmonics, response: Response, damper: str
) -> list[float] | list[str]:
    """Coefficients of x and then of y [m], or as many empty cells."""
    if not isinstance(response, Solution):
        return [""] * (2 * harmonics.rows)
    motion = response.journals[damper]
    coefficients = harmonics.change_from(motion.harmonics, motion.coefficients)
    written: list[float] = coefficients.T.ravel().tolist()
    return written
