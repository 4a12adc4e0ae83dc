"""Messages of response curves and orbits, read as a program in another language would."""

import struct
from functools import cache

import numpy as np
import pytest

pytest.importorskip("rclpy")

from geometry_msgs.msg import PolygonStamped
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import PointCloud2, PointField

from sfd_hbm_ros.hbm import Harmonics, JournalMotion
from sfd_hbm_ros.node.messages.curve import (
    curve_arrays_message,
    orbit_message,
    response_curve_message,
)
from sfd_hbm_ros.node.worker.curve_job import CurveJob, CurveResult, compute

from ...hbm.machines import random_machine
from ..graph import Time

FORMATS = {
    PointField.FLOAT64: "d",
    PointField.FLOAT32: "f",
    PointField.UINT32: "I",
    PointField.UINT16: "H",
    PointField.UINT8: "B",
}
STAMP = Time(nanoseconds=12_000_000_345)


@cache
def result(dampers: int = 1) -> CurveResult:
    machine = random_machine(2, dampers=dampers, elements=4)
    [result] = compute(CurveJob(machine, 1, 100.0, 600.0), lambda _: None)
    return result


def sent(message):
    return deserialize_message(serialize_message(message), type(message))


def read(cloud: PointCloud2) -> list[dict[str, float]]:
    """All points, by nothing but what the message says of its layout."""
    assert (cloud.height, cloud.row_step) == (1, cloud.width * cloud.point_step)
    assert len(cloud.data) == cloud.row_step
    order = ">" if cloud.is_bigendian else "<"
    data = bytes(cloud.data)
    return [
        {
            field.name: struct.unpack_from(
                order + FORMATS[field.datatype], data, i * cloud.point_step + field.offset
            )[0]
            for field in cloud.fields
        }
        for i in range(cloud.width)
    ]


def test_curve_without_branches_has_no_points():
    dampers = result().curve.dampers
    message = sent(response_curve_message(STAMP, (), (), dampers, 7))
    assert (message.width, message.row_step, len(message.data)) == (0, 0, 0)
    whole = response_curve_message(STAMP, result().curve.branches, (), dampers, 7)
    assert message.fields == whole.fields


def test_every_point_of_a_curve_arrives():
    branches = result().curve.branches
    cloud = sent(response_curve_message(STAMP, branches, (), result().curve.dampers, 7))
    assert (cloud.header.stamp.sec, cloud.header.stamp.nanosec) == (12, 345)
    assert cloud.header.frame_id  # without one no viewer shows it
    expected = [
        {
            "speed": solution.speed,
            "eccentricity": max(one.eccentricity_max for one in solution.journals.values()),
            "arc": arc,
            "branch": index,
            "stable": int(kind is None),
            "detached": 0,
            "x": np.float32(solution.speed * 30.0 / np.pi / 1000.0),
            "y": np.float32(solution.eccentricity_max),
            "z": 0.0,
            "revision": 7,
            **{f"{name}/max": one.eccentricity_max for name, one in solution.journals.items()},
        }
        for index, branch in enumerate(branches)
        for arc, (solution, kind) in enumerate(
            zip(branch.solutions, branch.instability, strict=True)
        )
    ]
    assert read(cloud) == expected
    assert {point["stable"] for point in expected} == {0, 1}
    assert cloud.is_dense


def test_detached_branches_follow_with_a_mark():
    branches = result().curve.branches
    points = read(
        sent(response_curve_message(STAMP, branches, branches[:1], result().curve.dampers, 7))
    )
    detached = [point for point in points if point["detached"]]
    assert len(detached) == len(branches[0].values)
    assert {point["branch"] for point in detached} == {len(branches)}
    assert points.index(detached[0]) == sum(len(branch.values) for branch in branches)


def test_a_curve_comes_as_arrays_of_every_damper():
    branches = result(2).curve.branches
    message = sent(curve_arrays_message(STAMP, branches, branches[:1], 7))
    assert (message.name[0], message.position[0]) == ("revision", 7.0)
    assert np.isnan(message.velocity[0])
    rows = list(zip(message.name, message.velocity, message.position, strict=True))[1:]
    expected = [
        (
            f"{damper}/{index}/{'stable' if kind is None else 'unstable'}",
            solution.speed,
            solution.journals[damper].eccentricity_max,
        )
        for damper in result(2).curve.dampers
        for index, branch in enumerate((*branches, branches[0]))
        for solution, kind in zip(branch.solutions, branch.instability, strict=True)
    ]
    assert len(result(2).curve.dampers) == 2
    assert rows == expected
    assert list(sent(curve_arrays_message(STAMP, (), (), 7)).name) == ["revision"]


def test_an_orbit_is_a_closed_line_in_metres():
    """An ellipse of half axes 3 and 2 um about (1, -1) um."""
    coefficients = np.array([[1e-6, -1e-6], [3e-6, 0.0], [0.0, 2e-6]])
    motion = JournalMotion("damper_1", 1e-4, Harmonics(1), coefficients)
    message = sent(orbit_message(STAMP, "rotor", motion, 64))
    assert isinstance(message, PolygonStamped)
    assert message.header.frame_id == "rotor"
    points = np.array([(point.x, point.y, point.z) for point in message.polygon.points])
    assert points.shape == (64, 3)
    np.testing.assert_allclose(
        ((points[:, 0] - 1e-6) / 3e-6) ** 2 + ((points[:, 1] + 1e-6) / 2e-6) ** 2, 1.0, rtol=1e-5
    )
    angles = np.unwrap(np.arctan2(points[:, 1] + 1e-6, points[:, 0] - 1e-6))
    assert (np.diff(angles) > 0.0).all()
    assert angles[-1] - angles[0] == pytest.approx(2 * np.pi * 63 / 64, abs=0.06)
    assert not points[:, 2].any()
