"""Order, age and rate of inputs, by hand-made times."""

import math

import pytest

from sfd_hbm_ros.machine import override, read_machine
from sfd_hbm_ros.node.inputs import FUTURE, Feed, InputError, Order, Pending, Rim

from .process import PAPER_ROTOR

SECOND = 10**9


def test_stamps_rise_and_zero_is_the_time_of_receipt():
    order = Order()
    assert order.check(5 * SECOND, now=6 * SECOND) == 5 * SECOND
    assert order.check(5 * SECOND, now=6 * SECOND) == 5 * SECOND
    assert order.check(0, now=6 * SECOND) == 6 * SECOND
    assert order.check(6 * SECOND + FUTURE, now=6 * SECOND) == 6 * SECOND + FUTURE


@pytest.mark.parametrize(
    ("stamp", "now", "reason"),
    [
        (4 * SECOND, 6 * SECOND, "1 s before that of an earlier"),
        (9 * SECOND, 6 * SECOND, "3 s in the future"),
        (-2 * SECOND, 6 * SECOND, "must not be negative, as -2 s"),
        (5 * SECOND, 0, "no time has come on /clock"),
    ],
)
def test_stamps_that_are_refused_leave_the_order_as_it_was(stamp, now, reason):
    order = Order()
    order.check(5 * SECOND, now=6 * SECOND)
    with pytest.raises(InputError, match=reason):
        order.check(stamp, now)
    assert order.newest == 5 * SECOND


def test_a_clock_that_was_set_back_begins_a_new_order():
    order = Order()
    order.check(100 * SECOND, now=100 * SECOND)
    assert order.check(20 * SECOND, now=20 * SECOND) == 20 * SECOND
    with pytest.raises(InputError, match="before that of an earlier"):
        order.check(19 * SECOND, now=20 * SECOND)


def test_feed_counts_and_ages():
    feed: Feed[float] = Feed("~/speed")
    assert feed.age(now=7.0) == feed.since_drop(now=7.0) == math.inf
    feed.accept(300.0, SECOND, SECOND, now=7.0)
    feed.drop("not so", now=8.0)
    assert (feed.value, feed.accepted, feed.dropped, feed.reason) == (300.0, 1, 1, "not so")
    assert (feed.age(now=9.5), feed.since_drop(now=9.5)) == (2.5, 1.5)
    feed.forget()
    assert (feed.value, feed.age(now=9.5), feed.accepted, feed.dropped) == (None, math.inf, 1, 1)


def test_a_refused_stamp_leaves_the_last_value():
    feed: Feed[float] = Feed("~/speed")
    feed.accept(300.0, SECOND, SECOND, now=7.0)
    with pytest.raises(InputError):
        feed.accept(400.0, SECOND // 2, SECOND, now=8.0)
    assert (feed.value, feed.accepted, feed.age(now=9.0)) == (300.0, 1, 2.0)


def test_streams_of_a_feed_have_orders_of_their_own():
    feed: Feed[float] = Feed("~/load")
    feed.accept(1.0, 2 * SECOND, 2 * SECOND, now=0.0, stream="disk_1")
    feed.accept(2.0, 1 * SECOND, 2 * SECOND, now=0.0, stream="disk_3")
    with pytest.raises(InputError):
        feed.accept(3.0, 1 * SECOND, 2 * SECOND, now=0.0, stream="disk_1")
    feed.forget()
    feed.accept(3.0, 1 * SECOND, 2 * SECOND, now=0.0, stream="disk_1")


def test_the_newest_request_is_granted_when_it_is_due():
    pending: Pending[str] = Pending(rate=4.0)
    assert not pending.waits
    assert pending.wait(now=10.0) == 0.0
    assert pending.take(now=10.0) is None
    assert pending.wait(now=10.0) == 0.0  # nothing was granted
    pending.put("first")
    assert pending.take(now=10.0) == "first"
    pending.put("second")
    assert pending.waits
    pending.put("newest")
    assert pending.wait(now=10.1) == pytest.approx(0.15)
    assert pending.take(now=10.25) == "newest"
    assert pending.take(now=10.5) is None
    pending.rate = 1.0
    assert pending.wait(now=10.5) == pytest.approx(0.75)


def test_a_speed_that_no_rotor_withstands_is_refused_with_the_rim_speed():
    paper = read_machine(PAPER_ROTOR)
    rim = Rim.of(paper)
    disk = next(disk for disk in paper.disks if disk.name == rim.name)
    assert disk.mass * rim.radius**2 / 2.0 == pytest.approx(disk.polar_inertia)
    fastest = 2000.0 / rim.radius
    rim.check(0.999 * fastest, 1000.0)
    with pytest.raises(InputError) as refused:
        rim.check(1e6, 1000.0)
    said = str(refused.value)
    assert said == (
        f"a speed must be below {fastest:.3g} rad/s for this machine, not 1e+06: the rim of "
        f"{rim.name} would move at {1e6 * rim.radius:.3g} m/s"
    )
    rim.check(9.9e5, 1e5)  # as the operator's range says more than the parts' inertia
    thick = override(paper, "shaft.0.outer_diameter", 0.4)
    assert Rim.of(thick) == Rim("the shaft", 0.2)
