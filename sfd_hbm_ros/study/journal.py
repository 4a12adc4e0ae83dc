"""The outcomes of a study on disk as they come, so that a kill loses none of them."""

import fcntl
import json
import os
import zlib
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from sfd_hbm_ros.study.errors import StudyError
from sfd_hbm_ros.study.task import Outcome, outcome_from

_CHECKSUM = "crc32"
_LARGEST = 256 << 20  # bytes; a study of the most variants has a tenth
_UNREADABLE = (ValueError, TypeError, KeyError, AttributeError, RecursionError)


class Journal:
    """A file of JSON lines: the study first, then the outcomes in the order in which they came.

    Each line has a checksum. One that was damaged counts as not there: its variant is computed
    again, as is that of a last line which a kill has cut off.

    Parameters
    ----------
    path : Path
        The file, which is made where there is none.
    study : mapping of str to JSON data
        All that the outcomes depend on.

    Attributes
    ----------
    outcomes : dict of int to Outcome
        The outcomes that it holds, by the variants' numbers.
    damaged : int
        Number of lines that were damaged.

    Raises
    ------
    OSError
        If it cannot be opened or written, or another process is at it.
    StudyError
        If it is of another study, or not a journal.
    """

    def __init__(self, path: Path, study: Mapping[str, Any]) -> None:
        self.path = path
        self.damaged = 0
        if path.exists() and not path.is_file():
            raise StudyError(f"{path}: is not a regular file")
        self._file = open(path, "a+b")  # noqa: SIM115 - open as long as the journal is
        try:
            self._lock()
            self.outcomes = self._resume(study)
        except BaseException:
            self._file.close()
            raise

    def add(self, number: int, outcome: Outcome) -> None:
        """Keep an outcome: when this returns it is on the disk."""
        self._write({"variant": number} | asdict(outcome))
        self.outcomes[number] = outcome

    def __enter__(self) -> "Journal":
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    def _lock(self) -> None:
        """Keep out other processes until the file is closed or this process is gone."""
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise BlockingIOError(f"{self.path}: another process is at this study") from None

    def _resume(self, study: Mapping[str, Any]) -> dict[int, Outcome]:
        """The outcomes that the file holds; a new file gets the study as its first line."""
        self._file.seek(0)
        content = self._file.read(_LARGEST + 1)
        if len(content) > _LARGEST:
            raise StudyError(f"{self.path}: is larger than the {_LARGEST >> 20} MiB of any study")
        whole, end, _ = content.rpartition(b"\n")  # a kill may have cut the last line off
        if not whole and _line(study).startswith(content):
            self._file.truncate(0)
            self._write(study)
            return {}
        begun, outcomes = self._parsed(whole)
        other = [key for key, value in study.items() if begun.get(key) != value]
        if other:
            raise StudyError(
                f"{self.path}: holds a study with another {', '.join(other)}; delete it, or give "
                "another --output"
            )
        self._file.truncate(len(whole + end))
        return outcomes

    def _parsed(self, text: bytes) -> tuple[dict[str, Any], dict[int, Outcome]]:
        """The study and the outcomes of the journal's lines."""
        first, *lines = text.split(b"\n")
        try:
            begun = _read(first)
        except _UNREADABLE:
            raise StudyError(f"{self.path}: is not the journal of a study") from None
        outcomes = {}
        for line in lines:
            try:
                data = _read(line)
                number = _number(data.pop("variant"))
                outcomes[number] = outcome_from(data)
            except _UNREADABLE:
                self.damaged += 1
        return begun, outcomes

    def _write(self, data: Mapping[str, Any]) -> None:
        self._file.write(_line(data))
        self._file.flush()
        os.fsync(self._file.fileno())


def _line(data: Mapping[str, Any]) -> bytes:
    """A line of data with their checksum."""
    return json.dumps({**data, _CHECKSUM: _checksum(data)}).encode() + b"\n"


def _read(line: bytes) -> dict[str, Any]:
    """The data of a line; a journal of older days has none whose checksum is right."""
    data = json.loads(line)
    given = data.pop(_CHECKSUM)
    if given != _checksum(data):
        raise ValueError
    return dict(data)


def _checksum(data: Mapping[str, Any]) -> int:
    return zlib.crc32(json.dumps(data).encode())


def _number(value: object) -> int:
    """A variant's number."""
    if type(value) is not int or value < 0:
        raise TypeError
    return value
