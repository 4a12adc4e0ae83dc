"""The state of a predictor in a file, so that after a restart it knows its branch and alarm.

The file is JSON text with a checksum. It is replaced in one step, so that a power cut leaves the
old state or the new one. No link is followed, nothing is replaced that is no state file, and no
message repeats what a file holds. A machine is known by its layout: its name, its nodes and the
names and nodes of its stations. Its numbers may change while it runs.
"""

import hashlib
import json
import os
from typing import Any

from sfd_hbm_ros.machine import Machine
from sfd_hbm_ros.machine.safe_file import read_regular, reason, replace_file
from sfd_hbm_ros.response.tracking.state import State, from_plain, to_plain

_FORMAT, _VERSION = "sfd_hbm_ros state", 1
_LARGEST = 16 * 1024 * 1024  # bytes; no state comes near it
_BEGINS = f'{{\n "format": "{_FORMAT}",\n'  # every state file's first lines


class StateFileError(RuntimeError):
    """A state file that cannot be used; the sentence begins with its path."""


def save_state(path: str | os.PathLike[str], machine: Machine, state: State) -> None:
    """Write a state file, in place of an older one in a single step.

    Raises
    ------
    StateFileError
        If the file cannot be written, or is a link, no regular file or no state file; an older
        one is as it was.
    """
    try:
        replace_file(path, _text(machine, state), _BEGINS)
    except (OSError, TypeError, ValueError) as error:
        raise StateFileError(f"{path}: cannot be written: {reason(error)}") from None


def load_state(path: str | os.PathLike[str], machine: Machine) -> State | None:
    """Read the state file of a machine; None if there is no file, as at the first start.

    Raises
    ------
    StateFileError
        If the file cannot be read, is a link, torn, of another format or version, or belongs to
        another machine.
    """
    try:
        content = _checked(_decoded(read_regular(path, _LARGEST, follow=False)))
    except FileNotFoundError:
        return None
    except RecursionError:
        raise StateFileError(f"{path}: refused: not a state file") from None
    except (OSError, ValueError) as error:
        raise StateFileError(f"{path}: refused: {reason(error)}") from None
    if content.get("machine") != fingerprint(machine):
        raise StateFileError(f"{path}: refused: foreign, the state of another machine")
    try:
        return from_plain(content["state"])
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError):
        problem = "no state, an entry is missing or not as it must be"
        raise StateFileError(f"{path}: refused: {problem}") from None


def fingerprint(machine: Machine) -> str:
    """Checksum of a machine's layout."""
    dampers = [damper.name for damper in machine.dampers]
    layout = [machine.name, machine.nodes, sorted(machine.stations.items()), dampers]
    return _checksum(layout)


def _text(machine: Machine, state: State) -> str:
    """The content of a state file."""
    content = {
        "format": _FORMAT,
        "version": _VERSION,
        "machine": fingerprint(machine),
        "state": to_plain(state),
    }
    whole = {**content, "checksum": _checksum(content)}
    return json.dumps(whole, indent=1, allow_nan=False) + "\n"


def _decoded(content: bytes) -> str:
    """The text of a file."""
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError:
        raise ValueError("not UTF-8 text") from None


def _checked(text: str) -> dict[str, Any]:
    """The content of a state file whose checksum is right."""
    try:
        content = json.loads(text)
    except (ValueError, RecursionError):
        raise ValueError("torn, it is not whole JSON text") from None
    if not isinstance(content, dict) or content.get("format") != _FORMAT:
        raise ValueError("not a state file")
    if content.get("version") != _VERSION:
        raise ValueError(f"of a version other than {_VERSION}")
    if content.pop("checksum", None) != _checksum(content):
        raise ValueError("torn, its checksum is wrong")
    return content


def _checksum(content: Any) -> str:
    """SHA-256 of a content, whatever the spaces in its text."""
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()
