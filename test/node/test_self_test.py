"""The service that checks the solver: it answers, and predictions go on meanwhile."""

import time

import pytest

from .graph import Remote  # first, as it skips the file without ROS

# isort: split
from diagnostic_msgs.srv import SelfTest

from .process import PAPER_ROTOR

OK = b"\x00"
CHECKS = 5


@pytest.fixture(scope="module")
def predictor(graph, start) -> Remote:
    start("-p", f"machine_file:={PAPER_ROTOR}", "-p", "stale_after:=60.0", "-p", "harmonics:=1")
    remote = Remote(graph)
    remote.meet()
    return remote


def test_every_check_is_passed_and_told(predictor):
    response = predictor.graph.call(SelfTest, "/predictor/self_test", SelfTest.Request())
    assert (response.id, response.passed) == ("predictor", b"\x01")
    assert [status.level for status in response.status] == [OK] * CHECKS
    for status in response.status:
        assert status.name.startswith("predictor: self-test, ")
        assert status.message.startswith("agrees with ")
        numbers = {pair.key.split(" ")[0]: float(pair.value) for pair in status.values}
        assert 0.0 <= numbers["deviation"] <= numbers["limit"]


def test_predictions_go_on_and_calls_queue_up(predictor):
    client = predictor.graph.node.create_client(SelfTest, "/predictor/self_test")
    predictor.graph.until(client.service_is_ready, "~/self_test is found")
    before = predictor.predict(300.0)[1]
    calls = [client.call_async(SelfTest.Request()) for _ in range(2)]
    meanwhile, start = 0, time.monotonic()
    while not all(call.done() for call in calls):
        assert predictor.predict(300.0)[1] == pytest.approx(before, rel=1e-9, abs=1e-15)
        meanwhile += 1
        assert time.monotonic() - start < 30.0
    assert meanwhile >= 10
    assert [call.result().passed for call in calls] == [b"\x01", b"\x01"]
