"""Bugs and requests that cannot be served: told apart, said in words, counted and survived."""

import pytest

from .graph import JointState  # first, as it skips the file without ROS

# isort: split
from diagnostic_msgs.srv import SelfTest
from lifecycle_msgs.srv import ChangeState
from rcl_interfaces.msg import Parameter
from rcl_interfaces.srv import GetParameters, SetParameters, SetParametersAtomically
from std_srvs.srv import SetBool, Trigger

from sfd_hbm_ros.kernels import load_kernels
from sfd_hbm_ros.node.guard import refused
from sfd_hbm_ros.response.tracking.tracker import Tracker
from sfd_hbm_ros.response.warning.settings import Level

from .conftest import predictor_here
from .process import PAPER_ROTOR


@pytest.fixture
def predictor(domain):
    load_kernels()
    given = {"machine_file": PAPER_ROTOR, "harmonics": 1, "publish_rate": 1000.0}
    with predictor_here(given) as node:
        yield node


def statuses(predictor):
    return {status.subject: status for status in predictor._statuses()}


def into(predictor, topic, message):
    """Give a message to what takes those on a topic."""
    [found] = [one for one in predictor.subscriptions if one.topic_name.endswith(f"/{topic}")]
    found.callback(message)


def test_a_bug_is_logged_with_its_traceback_counted_and_survived(predictor, monkeypatch, capfd):
    def stumble(self, speed):
        raise KeyError("a bug")

    with monkeypatch.context() as patch:
        patch.setattr(Tracker, "_advanced", stumble)
        for speed in (300.0, 301.0):
            into(predictor, "speed", JointState(velocity=[speed]))
    told = statuses(predictor)
    assert told["Solver"].level == Level.ERROR
    assert "unexpected error in the program, KeyError: 'a bug'" in told["Solver"].message
    assert told["Model"].level == Level.WARN
    assert "unexpected error, see the log: KeyError: 'a bug'" in told["Model"].message
    assert told["Model"].values["unexpected errors"] == "2"
    logged = capfd.readouterr().err
    assert logged.count("in stumble") == 1  # the same bug is not logged again and again
    assert 'raise KeyError("a bug")' in logged
    into(predictor, "speed", JointState(velocity=[302.0]))
    assert statuses(predictor)["Solver"].level == Level.OK
    assert statuses(predictor)["Model"].values["unexpected errors"] == "2"


def test_what_is_not_possible_is_no_bug(predictor, capfd):
    [service] = [one for one in predictor.services if one.srv_type is ChangeState]
    request = ChangeState.Request()
    request.transition.id = 2  # clean up, which an active node cannot
    handler = service.callback(request, ChangeState.Response())
    with pytest.raises(StopIteration) as done:
        handler.send(None)
    assert not done.value.value.success
    assert statuses(predictor)["Inputs"].values["requests: dropped"] == "1"
    assert statuses(predictor)["Model"].values["unexpected errors"] == "0"
    assert "Traceback" not in capfd.readouterr().err


def test_every_refusal_has_words_where_its_type_has_room():
    two = [Parameter(name="a"), Parameter(name="b")]
    assert refused(Trigger.Request(), Trigger.Response(), "why").message == "why"
    assert refused(SetBool.Request(), SetBool.Response(), "why").message == "why"
    response = refused(SetParameters.Request(parameters=two), SetParameters.Response(), "why")
    assert [(one.successful, one.reason) for one in response.results] == [(False, "why")] * 2
    kind = SetParametersAtomically
    response = refused(kind.Request(parameters=two), kind.Response(), "why")
    assert (response.result.successful, response.result.reason) == (False, "why")
    response = refused(SelfTest.Request(), SelfTest.Response(), "why")
    assert [status.message for status in response.status] == ["why"]
    empty = GetParameters.Response()
    assert refused(GetParameters.Request(), empty, "why") is empty
