"""The state of a predictor in a file, so that after a restart it knows its branch and alarm.

The file is JSON text with a checksum. It is replaced in one step, so that a power cut leaves the
old state or the new one. A machine is known by its layout: its name, its nodes and the names and
nodes of its stations. Its numbers may change while it runs.
"""

import hashlib
import json
import os
import stat
from pathlib import Path
from typing import Any

from sfd_hbm_ros.machine import Machine
from sfd_hbm_ros.response.tracking.state import State, from_plain, to_plain

_FORMAT, _VERSION = "sfd_hbm_ros state", 1
_LARGEST = 16 * 1024 * 1024  # bytes; no state comes near it


class StateFileError(RuntimeError):
    """A state file that cannot be used; the sentence begins with its path."""


def save_state(path: str | os.PathLike[str], machine: Machine, state: State) -> None:
    """Write a state file, in place of an older one in a single step.

    Raises
    ------
    StateFileError
        If the file cannot be written; an older one is as it was.
    """
    target = Path(os.path.realpath(path))  # a link stays one
    part = target.with_name(target.name + ".part")
    try:
        text = _text(machine, state)
        if target.exists():
            _check_regular(target)
        try:
            with open(part, "w", encoding="utf-8") as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
            os.replace(part, target)
            _sync_folder(target.parent)
        except OSError:
            part.unlink(missing_ok=True)
            raise
    except (OSError, TypeError, ValueError) as error:
        raise StateFileError(f"{path}: cannot be written: {_reason(error)}") from None


def load_state(path: str | os.PathLike[str], machine: Machine) -> State | None:
    """Read the state file of a machine; None if there is no file, as at the first start.

    Raises
    ------
    StateFileError
        If the file cannot be read, is torn, of another format or version, or belongs to another
        machine.
    """
    try:
        content = _checked(_read(path))
    except FileNotFoundError:
        return None
    except (OSError, ValueError) as error:
        raise StateFileError(f"{path}: refused: {_reason(error)}") from None
    if content["machine"] != fingerprint(machine):
        raise StateFileError(f"{path}: refused: foreign, the state of another machine")
    try:
        return from_plain(content["state"])
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise StateFileError(f"{path}: refused: no state: {error}") from None


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


def _read(path: str | os.PathLike[str]) -> str:
    """The text of a file."""
    _check_regular(path)
    with open(path, "rb") as file:
        text = file.read(_LARGEST + 1)
    if len(text) > _LARGEST:
        raise ValueError(f"larger than {_LARGEST} bytes")
    return text.decode("utf-8")


def _check_regular(path: str | os.PathLike[str]) -> None:
    """Refuse a device, a pipe or a folder, which is neither read nor replaced."""
    if not stat.S_ISREG(os.stat(path).st_mode):
        raise ValueError("not a regular file")


def _checked(text: str) -> dict[str, Any]:
    """The content of a state file whose checksum is right."""
    try:
        content = json.loads(text)
    except (ValueError, RecursionError):
        raise ValueError("torn, it is not whole JSON text") from None
    if not isinstance(content, dict) or content.get("format") != _FORMAT:
        raise ValueError("not a state file")
    if content.get("version") != _VERSION:
        raise ValueError(f"of version {content.get('version')}, not {_VERSION}")
    if content.pop("checksum", None) != _checksum(content):
        raise ValueError("torn, its checksum is wrong")
    return content


def _checksum(content: Any) -> str:
    """SHA-256 of a content, whatever the spaces in its text."""
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def _sync_folder(folder: Path) -> None:
    """Put a new name in a folder on the disk."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _reason(error: Exception) -> str:
    """What an error says, without its number."""
    return getattr(error, "strerror", None) or str(error)
