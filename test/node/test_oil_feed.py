"""The oil's temperature over DDS: the viscosity that follows, and what is refused."""

import math

import pytest

from .graph import Remote, Time  # first, as it skips the file without ROS

# isort: split
from sensor_msgs.msg import Temperature

from sfd_hbm_ros.machine.oil import Oil
from sfd_hbm_ros.node.oil_feed import DEADBAND

from .bistable import UPPER_ONLY, begin, changed, orbits

WARN = b"\x01"
PARAMETER = "dampers.damper_1.viscosity"
VG_32 = Oil.iso_vg(32, 865.0)


class Thermometer:
    """Publishes the oil's temperature."""

    def __init__(self, remote: Remote) -> None:
        self.remote = remote
        topic = f"{remote.name}/oil_temperature"
        self._publisher = remote.graph.node.create_publisher(Temperature, topic, 10)
        remote.graph.until(self._publisher.get_subscription_count, "~/oil_temperature is found")

    def send(self, celsius: float) -> None:
        message = Temperature(temperature=celsius)
        message.header.stamp = Time(nanoseconds=self.remote.now()).to_msg()
        self._publisher.publish(message)

    def until_viscosity(self, expected: float) -> None:
        """Wait until the parameter has a value [Pa s]."""
        near = pytest.approx(expected, rel=1e-12)
        self.remote.graph.until(lambda: self.remote.get(PARAMETER) == [near], "the viscosity")


@pytest.fixture(scope="module")
def predictor(graph, start, tmp_path_factory) -> Remote:
    folder = tmp_path_factory.mktemp("machine")
    return begin(start, graph, folder, UPPER_ONLY, "oil.grade:=32")


@pytest.fixture(scope="module")
def thermometer(predictor) -> Thermometer:
    return Thermometer(predictor)


def test_the_prediction_goes_by_the_temperature(predictor, thermometer):
    thermometer.send(60.0)
    viscosity = VG_32.viscosity(60.0)
    thermometer.until_viscosity(viscosity)
    [single] = orbits(UPPER_ONLY, changed(PARAMETER, viscosity))
    found = predictor.predict(UPPER_ONLY)[0]["damper_1/max"]
    assert found == pytest.approx(single, abs=1e-8)


def test_small_changes_are_left_alone(predictor, thermometer):
    thermometer.send(50.0)
    viscosity = VG_32.viscosity(50.0)
    thermometer.until_viscosity(viscosity)
    accepted = accepted_temperatures(predictor)
    assert VG_32.viscosity(50.1) == pytest.approx(viscosity, rel=DEADBAND)
    thermometer.send(50.1)
    predictor.graph.until(lambda: accepted_temperatures(predictor) > accepted, "it is accepted")
    assert predictor.get(PARAMETER) == [pytest.approx(viscosity, rel=1e-12)]


def accepted_temperatures(predictor: Remote) -> int:
    values = {pair.key: pair.value for pair in predictor.statuses["Inputs"].values}
    return int(values["/predictor/oil_temperature: accepted"])


def test_a_value_set_by_hand_is_overruled_by_the_next_temperature(predictor, thermometer):
    assert predictor.set({PARAMETER: 0.1}).successful
    thermometer.send(40.0)
    thermometer.until_viscosity(VG_32.viscosity(40.0))


@pytest.mark.parametrize(
    ("celsius", "reason"),
    [
        (200.0, "oil.temperature must be a temperature from -20 to 150 deg C, not 200"),
        (math.nan, "temperature must be a finite number"),
    ],
)
def test_impossible_temperatures_are_dropped(predictor, thermometer, celsius, reason):
    before = predictor.get(PARAMETER)
    thermometer.send(celsius)
    predictor.until_status("Inputs", WARN, reason)
    assert predictor.get(PARAMETER) == before


def test_the_oil_is_configured_as_a_whole(predictor, thermometer):
    data_sheet = {"oil.grade": 0, "oil.viscosity_40": 25.0, "oil.viscosity_100": 5.0}
    assert not predictor.set({"oil.viscosity_40": 25.0}).successful
    assert "oil.grade must be one of" in predictor.set({"oil.grade": 33}).reason
    assert predictor.set(data_sheet).successful
    thermometer.send(70.0)
    thermometer.until_viscosity(Oil(25.0, 5.0, 865.0).viscosity(70.0))
    assert predictor.set({"oil.viscosity_40": 0.0, "oil.viscosity_100": 0.0}).successful
    thermometer.send(20.0)
    predictor.until_status("Inputs", WARN, "no oil is configured")
