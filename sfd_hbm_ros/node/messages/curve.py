"""Messages with many points: response curves and orbits."""

from __future__ import annotations

from array import array
from collections.abc import Sequence

import numpy as np
from geometry_msgs.msg import Point32, Polygon, PolygonStamped
from numpy.typing import NDArray
from rclpy.time import Time
from sensor_msgs.msg import JointState, PointCloud2, PointField
from std_msgs.msg import Header

from sfd_hbm_ros.hbm import JournalMotion
from sfd_hbm_ros.response.curves.judged import CurveBranch
from sfd_hbm_ros.units import RPM

FRAME = "response_curve"
"""Frame of a response curve, in which x is the speed and y the eccentricity."""

CURVE_POINT = np.dtype(
    [
        ("speed", "<f8"),  # rotor speed [rad/s]
        ("eccentricity", "<f8"),  # greatest of any damper, of the clearance
        ("arc", "<u4"),  # index along the branch, from 0
        ("branch", "<u2"),  # index of the branch, from 0
        ("stable", "u1"),  # 1 if stable, 0 if not
        ("detached", "u1"),  # 1 if no run-up or coast-down meets the branch, 0 if one does
        ("x", "<f4"),  # rotor speed [1000 rpm], for who looks at points in space
        ("y", "<f4"),  # the eccentricity
        ("z", "<f4"),  # 0
        ("revision", "<u4"),  # which state of the machine the curve is of
    ]
)
"""Layout of a point of a response curve without its dampers, 40 bytes."""

_TYPES = {
    "f8": PointField.FLOAT64,
    "f4": PointField.FLOAT32,
    "u4": PointField.UINT32,
    "u2": PointField.UINT16,
    "u1": PointField.UINT8,
}


def curve_point(dampers: Sequence[str]) -> np.dtype[np.void]:
    """Return the layout of a point: `CURVE_POINT`, then DAMPER/max, each its eccentricity."""
    return np.dtype([*CURVE_POINT.descr, *((f"{damper}/max", "<f8") for damper in dampers)])


def response_curve_message(
    stamp: Time,
    branches: Sequence[CurveBranch],
    detached: Sequence[CurveBranch],
    dampers: Sequence[str],
    revision: int,
) -> PointCloud2:
    """Return a response curve over the speed, branch after branch, those detached at the end.

    The fields of a point are those of `curve_point`. Without branches there are no points.
    """
    layout = curve_point(dampers)
    parts = [
        _points(branch, index, index >= len(branches), layout, revision)
        for index, branch in enumerate((*branches, *detached))
    ]
    points = np.concatenate([np.empty(0, layout), *parts])
    return PointCloud2(
        header=Header(stamp=stamp.to_msg(), frame_id=FRAME),
        height=1,
        width=len(points),
        fields=_fields(layout),
        is_bigendian=False,
        point_step=layout.itemsize,
        row_step=points.nbytes,
        data=points.tobytes(),
        is_dense=bool(np.isfinite(points["eccentricity"]).all()),
    )


def curve_arrays_message(
    stamp: Time,
    branches: Sequence[CurveBranch],
    detached: Sequence[CurveBranch],
    revision: int,
) -> JointState:
    """Return a response curve as arrays: speeds [rad/s] in velocity, eccentricities in position.

    Damper after damper, and branch after branch of each, the name of every point is
    DAMPER/BRANCH/stable or DAMPER/BRANCH/unstable. The first is `revision`, at no speed.
    """
    names, speeds, heights = ["revision"], [np.array([np.nan])], [np.array([float(revision)])]
    every = (*branches, *detached)
    for damper in every[0].eccentricities if every else ():
        for index, branch in enumerate(every):
            words = ("unstable", "stable")
            names += [f"{damper}/{index}/{words[stable]}" for stable in branch.stable.tolist()]
            speeds.append(branch.speed)
            heights.append(branch.eccentricity(damper))
    return JointState(
        header=Header(stamp=stamp.to_msg(), frame_id=FRAME),
        name=names,
        position=array("d", np.concatenate(heights).tolist()),
        velocity=array("d", np.concatenate(speeds).tolist()),
    )


def orbit_message(stamp: Time, frame: str, motion: JournalMotion, points: int) -> PolygonStamped:
    """Return the orbit of one journal [m], in its damper, as so many points of a closed line."""
    orbit = motion.orbit(points).tolist()
    header = Header(stamp=stamp.to_msg(), frame_id=frame)
    return PolygonStamped(header=header, polygon=Polygon(points=[_point(*at) for at in orbit]))


def _points(
    branch: CurveBranch, index: int, detached: bool, layout: np.dtype[np.void], revision: int
) -> NDArray[np.void]:
    """The points of one branch."""
    points = np.zeros(len(branch.values), layout)
    points["speed"] = branch.speed
    points["eccentricity"] = points["y"] = branch.worst_eccentricity
    points["x"] = branch.speed / RPM / 1000.0
    points["arc"] = np.arange(len(points))
    points["branch"] = index
    points["stable"] = branch.stable
    points["detached"] = detached
    points["revision"] = revision
    for damper, eccentricity in branch.eccentricities.items():
        points[f"{damper}/max"] = eccentricity
    return points


def _fields(layout: np.dtype[np.void]) -> list[PointField]:
    """Return where the fields of a layout stand, and as what."""
    assert layout.fields is not None
    return [
        PointField(name=name, offset=offset, datatype=_TYPES[kind.str[1:]], count=1)
        for name, (kind, offset, *_) in layout.fields.items()
    ]


def _point(x: float, y: float) -> Point32:
    return Point32(x=x, y=y)
