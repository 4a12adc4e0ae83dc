"""Ten thousand things that nobody should send, given to the real node without DDS in between.

Whatever comes, no callback raises. What is not allowed changes nothing, one sentence says why, and
afterwards the predictor predicts rightly.
"""

import array
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from .graph import JointState, WrenchStamped  # first, as it skips the file without ROS

# isort: split
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Vector3, Wrench
from rclpy.parameter import Parameter
from sensor_msgs.msg import Temperature
from std_msgs.msg import Header

from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve
from sfd_hbm_ros.machine import read_machine
from sfd_hbm_ros.node.predictor import Predictor
from sfd_hbm_ros.node.unbalance import agreed

from .conftest import predictor_here
from .process import PAPER_ROTOR

Messages = st.SearchStrategy[Any]

AT_ONCE = 10  # things in one of the examples, which cost time of their own
SPEED = 300.0  # rad/s
SELDOM, OFTEN = 0.1, 1000.0  # predictions a second at most: they take longer than all the rest
NUMBERS = st.one_of(
    st.floats(), st.floats(0.0, 1000.0), st.sampled_from([0.0, -0.0, 5e-324, 1e300])
)
TEXTS = st.one_of(st.text(max_size=20), st.sampled_from(["", "x" * 10_000, "ä", "世", "\0", "."]))
STAMPS = st.one_of(
    st.just(Time()),  # the time of receipt
    st.builds(Time, sec=st.integers(-(2**31), 2**31 - 1), nanosec=st.integers(0, 2**32 - 1)),
)
STATIONS = TEXTS | st.sampled_from(["disk_1", "disk_3", "damper_1", "dampers.damper_1"])
HARMONICS = TEXTS | st.builds(
    "{}/{}/{}x{}".format,
    st.sampled_from(["damper_1", "damper_2"]),
    st.sampled_from("xyz"),
    st.integers(-1, 40) | st.floats(0.0, 3.0),
    st.sampled_from(["", "/amplitude", "/phase", "/other"]),
)


def headers(frames: st.SearchStrategy[str] = TEXTS) -> st.SearchStrategy[Header]:
    return st.builds(Header, stamp=STAMPS, frame_id=frames)


def joint_states(names: st.SearchStrategy[str] = TEXTS) -> Messages:
    """Messages of names and numbers, which may or may not pair."""
    some = st.lists(NUMBERS, max_size=4) | st.lists(NUMBERS, min_size=1, max_size=1)
    numbers = some.map(lambda values: array.array("d", values))
    pairs = st.lists(st.tuples(names, NUMBERS), max_size=4)
    paired = pairs.map(
        lambda given: {"name": [n for n, _ in given], "position": [x for _, x in given]}
    )
    any_names = st.fixed_dictionaries({"name": st.lists(names, max_size=4), "position": numbers})
    fields = st.tuples(paired | any_names, headers(), numbers)
    return fields.map(lambda f: JointState(**f[0], header=f[1], velocity=f[2]))


MESSAGES = {
    "speed": (2000, joint_states()),
    "load": (
        2000,
        st.builds(
            WrenchStamped,
            header=headers(STATIONS),
            wrench=st.builds(Wrench, force=st.builds(Vector3, x=NUMBERS, y=NUMBERS, z=NUMBERS)),
        ),
    ),
    "oil_temperature": (1000, st.builds(Temperature, header=headers(), temperature=NUMBERS)),
    "measured": (2000, joint_states(HARMONICS)),
    "what_if/request": (1000, joint_states()),
}
VALUES = st.one_of(
    NUMBERS,
    st.booleans(),
    st.integers(-(2**63), 2**63 - 1),
    st.integers(0, 40),
    TEXTS,
    st.lists(st.floats(), min_size=1, max_size=3),
    st.lists(st.binary(min_size=1, max_size=1), max_size=3),
)


@pytest.fixture(scope="module")
def predictor(domain) -> Iterator[Predictor]:
    given = {
        "machine_file": PAPER_ROTOR,
        "harmonics": 1,
        "publish_rate": SELDOM,
        "stale_after": 3600.0,
        "oil.grade": 32,
    }
    with predictor_here(given) as node:
        yield node


@pytest.fixture
def at_work(predictor: Predictor) -> Iterator[Predictor]:
    """The predictor, which must predict rightly afterwards."""
    before = values(predictor)
    yield predictor
    now = values(predictor)
    put(predictor, {key: value for key, value in before.items() if now[key] != value})
    predictor.trigger_deactivate()
    predictor.trigger_cleanup()  # which forgets the loads
    predictor.trigger_configure()
    predictor.trigger_activate()
    put(predictor, {"publish_rate": OFTEN})
    into(predictor, "speed")(JointState(velocity=[SPEED]))
    put(predictor, {"publish_rate": SELDOM})
    prediction = predictor._operation.prediction
    assert prediction is not None
    right = solve(HarmonicBalance(read_machine(PAPER_ROTOR), Harmonics(1)), SPEED)
    expected = right.journals["damper_1"].eccentricity_max
    assert prediction.journals["damper_1"].eccentricity_max == pytest.approx(expected, rel=1e-9)


def put(predictor: Predictor, given: dict[str, Any]) -> None:
    """Set parameters that are allowed."""
    parameters = [Parameter(key, value=value) for key, value in given.items()]
    assert predictor.set_parameters_atomically(parameters).successful


def into(predictor: Predictor, topic: str) -> Callable[[Any], None]:
    """Return what takes the messages on a topic."""
    [found] = [one for one in predictor.subscriptions if one.topic_name.endswith(f"/{topic}")]
    taken: Callable[[Any], None] = found.callback
    return taken


def values(predictor: Predictor) -> dict[str, Any]:
    """Return the values of all parameters."""
    return {key: one.value for key, one in predictor.get_parameters_by_prefix("").items()}


def as_numbers(value: Any, before: Any) -> Any:
    """Return a value with floats for integers where there were floats before."""
    if isinstance(value, list):
        return [as_numbers(one, 0.0 if type(one) is int else one) for one in value]
    return float(value) if type(before) is float else value


def each(number: int, things: st.SearchStrategy[Any], act: Callable[[Any], None]) -> None:
    """Act on a number of random things."""

    def all_of(some: list[Any]) -> None:
        for one in some:
            act(one)

    lists = st.lists(things, min_size=AT_ONCE, max_size=AT_ONCE)
    settings(max_examples=number // AT_ONCE, deadline=None)(given(lists)(all_of))()


@pytest.mark.parametrize("topic", MESSAGES)
def test_messages(at_work, topic):
    take = into(at_work, topic)
    number, messages = MESSAGES[topic]
    each(number, messages, lambda message: take(message))
    for status in at_work._statuses():
        assert "\n" not in status.message
        assert len(status.message) < 1000


def test_parameters(at_work):
    names = st.sampled_from(sorted(values(at_work))) | TEXTS
    accepted = refused = 0

    def act(given: dict[str, Any]) -> None:
        nonlocal accepted, refused
        before = values(at_work)
        result = at_work.set_parameters_atomically(
            [Parameter(name, value=value) for name, value in given.items()]
        )
        accepted, refused = accepted + result.successful, refused + (not result.successful)
        if result.successful:
            taken = {name: as_numbers(value, before[name]) for name, value in given.items()}
            assert values(at_work) == {**before, **agreed(taken, before)}
        else:
            assert values(at_work) == before
            assert "\n" not in result.reason
            assert 0 < len(result.reason) < 1000

    each(4000, st.dictionaries(names, VALUES, min_size=1, max_size=3), act)
    assert min(accepted, refused) > 100
