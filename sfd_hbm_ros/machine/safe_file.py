"""Files whose names may come from others: read and replaced so that nothing else is touched.

Only regular files are read, opened without waiting and within a time. What is written goes to a
new file first, which no link leads elsewhere, and replaces only what was written here before.
"""

from __future__ import annotations

import os
import stat
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import TypeVar

FilePath = str | os.PathLike[str]
T = TypeVar("T")

READ_SECONDS = 2.0
"""Time within which a file must be read [s]; a disk that is far away may never answer."""

MOST_ASIDE = 100
"""Refused files that are kept beside the file whose name they had."""


class TooLargeError(ValueError):
    """A file that is larger than it may be."""


_NEW = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC
_READ = os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC


def read_regular(path: FilePath, most: int, *, follow: bool) -> bytes:
    """Return the content of a regular file.

    Parameters
    ----------
    path : path-like
        The file.
    most : int
        Bytes that it may have.
    follow : bool
        Whether the path may be a link to the file.

    Raises
    ------
    OSError, ValueError
        If it cannot be read, not within `READ_SECONDS`, is no regular file, or is larger.
    """
    return _in_time(lambda: _read(path, most, follow))


def replace_file(path: FilePath, text: str, begins: str) -> None:
    """Write a file in place of an older one in a single step, by way of ``PATH.part``.

    Parameters
    ----------
    path : path-like
        The file.
    text : str
        Its new content.
    begins : str
        What every file written here begins with; any other is left alone.

    Raises
    ------
    OSError, ValueError
        If the file cannot be written, or something else is there; an older one is as it was.
    """
    target = Path(os.path.abspath(path))
    part = target.with_name(target.name + ".part")
    _check_own(target, begins)
    _check_own(part, begins)  # left by a process that was killed while it wrote
    part.unlink(missing_ok=True)
    try:
        with open(os.open(part, _NEW, 0o666), "w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, target)
        _sync_folder(target.parent)
    except OSError:
        part.unlink(missing_ok=True)
        raise


def put_aside(path: FilePath) -> Path:
    """Rename a file that is of no use to ``PATH.refused``, or ``PATH.refused.1`` and so on.

    Nothing that has such a name already is touched.

    Raises
    ------
    OSError, ValueError
        If it cannot be renamed, or all names are taken; it is where it was.
    """
    target = Path(os.path.abspath(path))
    _check_regular(os.lstat(target))
    for number in range(MOST_ASIDE):
        suffix = f".refused.{number}" if number else ".refused"
        aside = target.with_name(target.name + suffix)
        with suppress(FileExistsError):
            os.close(os.open(aside, _NEW, 0o600))
            try:
                os.replace(target, aside)
            except OSError:
                aside.unlink()
                raise
            return aside
    raise ValueError(f"{MOST_ASIDE} refused files are there already")


def reason(error: Exception) -> str:
    """Return what an error of these functions says, without its number and path."""
    return getattr(error, "strerror", None) or str(error)


def _read(path: FilePath, most: int, follow: bool) -> bytes:
    """Read a file, however long that takes."""
    if not follow:
        _check_regular(os.lstat(path))  # which says more of a link than its refusal does
    # Looked at before it is opened, too: to open a device can have effects.
    _check_regular(os.stat(path))
    with open(os.open(path, _READ | (0 if follow else os.O_NOFOLLOW)), "rb") as file:
        _check_regular(os.fstat(file.fileno()))
        content = file.read(most + 1)
    if len(content) > most:
        raise TooLargeError(f"larger than {most} bytes")
    return content


def _check_own(path: Path, begins: str) -> None:
    """Refuse what was not written here, in whole or in part; what is not there is fine."""
    try:
        _check_regular(os.lstat(path))
        with open(os.open(path, _READ | os.O_NOFOLLOW), "rb") as file:
            begun = file.read(len(begins.encode()))
    except FileNotFoundError:
        return
    if not begins.encode().startswith(begun):
        raise ValueError(f"{path.name} is there already and was not written by this program")


def _check_regular(found: os.stat_result) -> None:
    """Refuse a link, a device, a pipe or a folder."""
    if stat.S_ISLNK(found.st_mode):
        raise ValueError("a link, which is not followed")
    if not stat.S_ISREG(found.st_mode):
        raise ValueError("not a regular file")


def _sync_folder(folder: Path) -> None:
    """Put a new name in a folder on the disk."""
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _in_time(work: Callable[[], T]) -> T:
    """Return what a function returns or raise what it raises, within `READ_SECONDS`.

    A thread that still waits for a disk is left behind; it keeps no process from ending.
    """
    outcome: SimpleQueue[tuple[T | None, Exception | None]] = SimpleQueue()

    def attempt() -> None:
        try:
            outcome.put((work(), None))
        except Exception as error:
            outcome.put((None, error))

    threading.Thread(target=attempt, daemon=True).start()
    try:
        result, error = outcome.get(timeout=READ_SECONDS)
    except Empty:
        raise ValueError(f"not read within {READ_SECONDS:g} s") from None
    if error is not None:
        raise error
    return result  # type: ignore[return-value]  # as there was no error
