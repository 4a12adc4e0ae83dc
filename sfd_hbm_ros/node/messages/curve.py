"""Messages with many points: response curves and orbits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from geometry_msgs.msg import Point32, Polygon, PolygonStamped
from numpy.typing import NDArray
from rclpy.time import Time
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header

from sfd_hbm_ros.hbm import JournalMotion
from sfd_hbm_ros.response.curves.judged import CurveBranch

CURVE_POINT = np.dtype(
    [
        ("speed", "<f8"),  # rotor speed [rad/s]
        ("eccentricity", "<f8"),  # greatest of any damper, of the clearance
        ("arc", "<u4"),  # index along the branch, from 0
        ("branch", "<u2"),  # index of the branch, from 0
        ("stable", "u1"),  # 1 if stable, 0 if not
        ("detached", "u1"),  # 1 if no run-up or coast-down meets the branch, 0 if one does
    ]
)
"""Layout of a point of a response curve, 24 bytes. There are no x, y and z, as it lies nowhere."""

_TYPES = {
    "f8": PointField.FLOAT64,
    "u4": PointField.UINT32,
    "u2": PointField.UINT16,
    "u1": PointField.UINT8,
}


def response_curve_message(
    stamp: Time, branches: Sequence[CurveBranch], detached: Sequence[CurveBranch]
) -> PointCloud2:
    """Return a response curve over the speed, branch after branch, those detached at the end.

    The fields of a point are those of `CURVE_POINT`. Without branches there are no points.
    """
    parts = [
        _points(branch, index, index >= len(branches))
        for index, branch in enumerate((*branches, *detached))
    ]
    points = np.concatenate([np.empty(0, CURVE_POINT), *parts])
    return PointCloud2(
        header=Header(stamp=stamp.to_msg()),
        height=1,
        width=len(points),
        fields=_fields(),
        is_bigendian=False,
        point_step=CURVE_POINT.itemsize,
        row_step=points.nbytes,
        data=points.tobytes(),
        is_dense=bool(np.isfinite(points["eccentricity"]).all()),
    )


def orbit_message(stamp: Time, frame: str, motion: JournalMotion, points: int) -> PolygonStamped:
    """Return the orbit of one journal [m], in its damper, as so many points of a closed line."""
    orbit = motion.orbit(points).tolist()
    header = Header(stamp=stamp.to_msg(), frame_id=frame)
    return PolygonStamped(header=header, polygon=Polygon(points=[_point(*at) for at in orbit]))


def _points(branch: CurveBranch, index: int, detached: bool) -> NDArray[np.void]:
    """The points of one branch."""
    points = np.empty(len(branch.values), CURVE_POINT)
    points["speed"] = branch.speed
    points["eccentricity"] = branch.worst_eccentricity
    points["arc"] = np.arange(len(points))
    points["branch"] = index
    points["stable"] = branch.stable
    points["detached"] = detached
    return points


def _fields() -> list[PointField]:
    """Return where the fields of `CURVE_POINT` stand, and as what."""
    assert CURVE_POINT.fields is not None
    return [
        PointField(name=name, offset=offset, datatype=_TYPES[kind.str[1:]], count=1)
        for name, (kind, offset, *_) in CURVE_POINT.fields.items()
    ]


def _point(x: float, y: float) -> Point32:
    return Point32(x=x, y=y)
