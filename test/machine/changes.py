"""Good data made bad in one place, and the sentence with which they are refused."""

import copy
from typing import Any

import pytest

from sfd_hbm_ros.machine import MachineError, machine_from_dict

DELETED = object()


def changed(data: dict[str, Any], path: str, value: object) -> dict[str, Any]:
    """Return a copy of the data with one entry replaced, added or deleted."""
    copied = copy.deepcopy(data)
    *parents, last = path.split(".")
    entry: Any = copied
    for label in parents:
        entry = entry[_key(entry, label)]
    if value is DELETED:
        del entry[_key(entry, last)]
    else:
        entry[_key(entry, last)] = value
    return copied


def refusal(data: object) -> str:
    """Return the sentence with which data are refused."""
    with pytest.raises(MachineError) as error:
        machine_from_dict(data)  # type: ignore[arg-type]
    sentence = str(error.value)
    assert "\n" not in sentence
    assert len(sentence) < 250
    return sentence


def _key(entry: Any, label: str) -> Any:
    """Return the index of a list's item by its name, station or index; else the label."""
    if isinstance(entry, dict):
        return label
    labels = [item.get("name", item.get("station", str(i))) for i, item in enumerate(entry)]
    return labels.index(label)
