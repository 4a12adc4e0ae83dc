"""Unbalances as parameters: of single stations and in lists, which always agree."""

import pytest
import yaml

from sfd_hbm_ros.machine import machine_to_dict, override, override_all, read_machine

from .graph import Remote  # first of what needs ROS, as it skips the file without it
from .process import PAPER_ROTOR
from .test_predictions import check, solved

# isort: split
from sfd_hbm_ros.node.schema import ParameterError
from sfd_hbm_ros.node.unbalance import LIST_SCHEMA, LISTS, agreed, everywhere, listed

PAPER = read_machine(PAPER_ROTOR)
SINGLE = {
    f"unbalance.{station}.{key}": 0.0
    for station in PAPER.stations
    for key in ("magnitude", "phase")
} | {"unbalance.disk_2.magnitude": 4.319e-4}
KNOWN = SINGLE | listed(SINGLE)
THREE = ["disk_1", "disk_2", "disk_3"]


def lists(stations, magnitudes, phases):
    return dict(zip(LISTS, (stations, magnitudes, phases), strict=True))


def test_every_station_has_an_unbalance():
    machine = everywhere(PAPER)
    assert [one.station for one in machine.unbalance] == list(PAPER.stations)
    assert [one for one in machine.unbalance if one.magnitude] == list(PAPER.unbalance)


def test_lists_set_every_station():
    given = lists(["disk_3", "disk_1"], [1e-4, 2e-4], [0.5, -0.5])
    values = agreed(given, KNOWN)
    assert {name: value for name, value in values.items() if value and name not in LISTS} == {
        "unbalance.disk_1.magnitude": 2e-4,
        "unbalance.disk_1.phase": -0.5,
        "unbalance.disk_3.magnitude": 1e-4,
        "unbalance.disk_3.phase": 0.5,
    }
    assert values["unbalance.disk_2.magnitude"] == 0.0
    assert values.keys() == KNOWN.keys()


def test_single_stations_set_the_lists():
    values = agreed({"unbalance.disk_1.magnitude": 1e-4, "gravity": True}, KNOWN)
    assert values == {
        "unbalance.disk_1.magnitude": 1e-4,
        "gravity": True,
        **lists(["disk_1", "disk_2"], [1e-4, 4.319e-4], [0.0, 0.0]),
    }


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({LISTS[1]: [3e-4]}, lists(["disk_2"], [3e-4], [0.0])),
        ({LISTS[2]: [0.3]}, lists(["disk_2"], [4.319e-4], [0.3])),
        ({LISTS[0]: THREE, LISTS[1]: [1e-4] * 3}, lists(THREE, [1e-4] * 3, [0.0] * 3)),
        (lists([], [], []), lists([], [], [])),
    ],
)
def test_lists_that_are_left_out_stay(given, expected):
    values = agreed(given, KNOWN)
    assert {name: values[name] for name in LISTS} == expected


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        (
            {LISTS[0]: THREE},
            "unbalance.magnitudes must hold 3 numbers, one for each of unbalance.stations, not 1; "
            "they can be set together by set_parameters_atomically",
        ),
        (
            lists(["disk_2"], [1e-4], []),
            "unbalance.phases must hold 1 numbers, one for each of unbalance.stations, not 0; "
            "they can be set together by set_parameters_atomically",
        ),
        (
            lists(["disk_2", "disk_4"], [1e-4] * 2, [0.0] * 2),
            "unbalance.stations[1] must be one of the stations disk_1, disk_2, disk_3, bearing_1, "
            "damper_1, not 'disk_4' (did you mean disk_3?)",
        ),
        (
            lists(["disk_2", "disk_2"], [1e-4] * 2, [0.0] * 2),
            "unbalance.stations must not hold disk_2 twice",
        ),
        (
            {LISTS[1]: [1e-4], "unbalance.disk_1.phase": 0.1},
            "unbalance.disk_1.phase must be 0.0 as the lists of unbalances say, not 0.1",
        ),
    ],
)
def test_what_does_not_go_together_is_refused(given, sentence):
    with pytest.raises(ParameterError) as refused:
        agreed(given, KNOWN)
    assert str(refused.value) == sentence


def test_what_was_saved_can_be_set_again():
    """Whoever saves all parameters saves both ways; a phase may wait for its magnitude."""
    saved = {**SINGLE, "unbalance.disk_1.phase": 0.5}
    saved |= listed(saved)
    assert saved[LISTS[0]] == ["disk_1", "disk_2"]
    assert agreed(saved, KNOWN) == saved


def test_what_is_no_list_of_its_kind_is_refused():
    stations, magnitudes, _ = LIST_SCHEMA
    assert magnitudes.convert((1, 2.5)) == [1.0, 2.5]
    for spec, value, sentence in (
        (magnitudes, 1e-4, "must be a list of numbers [kg m], not 0.0001"),
        (magnitudes, [1e-4, True], "must be a list of numbers [kg m], not [0.0001, True]"),
        (stations, "disk_1", "must be a list of names, not 'disk_1'"),
        (stations, [1], "must be a list of names, not [1]"),
    ):
        with pytest.raises(ParameterError) as refused:
            spec.convert(value)
        assert str(refused.value) == f"{spec.name} {sentence}"


@pytest.fixture(scope="module")
def predictor(graph, start) -> Remote:
    start("-p", f"machine_file:={PAPER_ROTOR}", "-p", "stale_after:=60.0")
    remote = Remote(graph)
    remote.meet()
    return remote


def test_the_predictor_takes_lists_and_single_stations(predictor):
    given = lists(THREE, [1e-4, 2e-4, 3e-4], [0.0, 0.5, -0.5])
    assert predictor.set(given).successful
    changes = {
        f"unbalance.{station}.{key}": value
        for key, values in (("magnitude", given[LISTS[1]]), ("phase", given[LISTS[2]]))
        for station, value in zip(THREE, values, strict=True)
    }
    check(predictor.predict(350.0), solved(350.0, override_all(everywhere(PAPER), changes)))
    assert predictor.get(*changes) == list(changes.values())
    changes["unbalance.disk_2.magnitude"] = 0.0
    assert predictor.set({"unbalance.disk_2.magnitude": 0.0}).successful
    check(predictor.predict(350.0), solved(350.0, override_all(everywhere(PAPER), changes)))
    stations, magnitudes, phases = predictor.get(*LISTS)
    assert (stations, list(magnitudes), list(phases)) == (
        THREE,
        [1e-4, 0.0, 3e-4],
        [0.0, 0.5, -0.5],
    )


def test_lists_that_are_refused_leave_all_as_it_was(predictor):
    names = (*LISTS, *SINGLE)
    before = predictor.get(*names)
    refused = predictor.set(lists(["disk_1"], [-1e-4], [0.0]))
    assert refused.reason.startswith("unbalance.disk_1.magnitude must be a finite number")
    assert "[kg m]" in refused.reason
    assert not predictor.set({LISTS[1]: [1e-4]}).successful
    assert predictor.get(*names) == before


def test_no_unbalance_at_all(predictor):
    empty = {LISTS[0]: [], LISTS[1]: [], LISTS[2]: []}
    assert not any(agreed(empty, KNOWN).values())
    assert predictor.set(dict.fromkeys(SINGLE, 0.0)).successful
    eccentricity, _ = predictor.predict(350.0)
    assert eccentricity["damper_1/max"] < 1e-12
    assert [list(one) for one in predictor.get(*LISTS)] == [[], [], []]


def test_lists_given_at_the_start(graph, start):
    start(
        *("-r", "__node:=listed", "-p", f"machine_file:={PAPER_ROTOR}"),
        *(
            "-p",
            "unbalance.stations:=[disk_1, disk_3]",
            "-p",
            "unbalance.magnitudes:=[1e-4, 2e-4]",
        ),
    )
    remote = Remote(graph, "/listed")
    remote.meet()
    names = [f"unbalance.{station}.magnitude" for station in THREE]
    assert remote.get(*names) == [1e-4, 0.0, 2e-4]


def test_a_machine_without_an_unbalance_gets_one(graph, start, tmp_path):
    file = tmp_path / "balanced.yaml"
    file.write_text(yaml.safe_dump(machine_to_dict(override(PAPER, "unbalance", []))))
    start("-r", "__node:=balanced", "-p", f"machine_file:={file}", "-p", "stale_after:=60.0")
    remote = Remote(graph, "/balanced")
    remote.meet()
    assert [list(one) for one in remote.get(*LISTS)] == [[], [], []]
    assert remote.set(lists(["disk_2"], [4.319e-4], [0.0])).successful
    check(remote.predict(350.0), solved(350.0))
