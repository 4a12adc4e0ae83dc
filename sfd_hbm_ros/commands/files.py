"""The files that a verb reads and writes, looked at before anything is computed."""

import argparse
import io
import os
import stat
import tempfile
from collections.abc import Sequence
from pathlib import Path

from sfd_hbm_ros.commands.arguments import UsageError
from sfd_hbm_ros.machine.safe_file import reason


def check_outputs(chosen: argparse.Namespace, tables: Sequence[str] = (".csv",)) -> None:
    """Check that what a verb is to write can be written, over none of what it reads.

    Parameters
    ----------
    chosen : Namespace
        The arguments: `machine`, and where the verb has them `output`, `journal` and `picture`.
    tables : sequence of str
        Endings that name a form of tables.

    Raises
    ------
    UsageError
        If an ending stands for no form that can be written, a folder or file cannot be written,
        or a file would be written over another one of the command's.
    """
    others = {"the machine file": Path(chosen.machine)}
    for option in ("output", "journal", "picture"):
        given = getattr(chosen, option, None)
        if given is None:
            continue
        path = Path(given)
        place = f"--{option} {path}" if option != "journal" else f"{path}, the study's journal"
        if option == "output" and path.suffix.lower() not in tables:
            raise UsageError(f"{place}: the name of a table must end in {' or '.join(tables)}")
        if option == "picture":
            _check_picture(place, path)
        for what, other in others.items():
            if _is_same_file(path, other):
                raise UsageError(f"{place}: would overwrite {what}; give another name")
        _check_writable(place, path)
        others[f"the file of --{option}"] = path


def check_figures(folder: Path) -> None:
    """Check that pictures can be written into a folder, which need not be there yet.

    Raises
    ------
    UsageError
        If not.
    """
    place = f"--figures {folder}"
    there = folder.absolute()
    while not there.exists() and there != there.parent:
        there = there.parent
    _check_folder(place, there)
    _check_picture(place, Path("figure.png"))


def _is_same_file(one: Path, other: Path) -> bool:
    """Whether two names are of one file, whatever links lead to it."""
    try:
        return os.path.samefile(one, other)
    except (OSError, ValueError):  # one of them is not there yet
        return os.path.abspath(one) == os.path.abspath(other)


def _check_writable(place: str, path: Path) -> None:
    """Check that a file can be made or replaced; nothing is changed and nothing left behind."""
    try:
        target = Path(os.path.realpath(path))
        if target.exists():
            if not stat.S_ISREG(target.stat().st_mode):
                raise UsageError(f"{place}: cannot be written: not a regular file")
            os.close(os.open(target, os.O_WRONLY))
            return
    except (OSError, UnicodeError) as error:
        raise UsageError(f"{place}: cannot be written: {reason(error)}") from None
    _check_folder(place, target.parent)


def _check_folder(place: str, folder: Path) -> None:
    """Make a file without a name in a folder."""
    try:
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        problem = f"{place}: no file can be made in the folder {folder}: {reason(error)}"
        raise UsageError(problem) from None


def _check_picture(place: str, path: Path) -> None:
    """Draw nothing in the picture's form: the surest way to know that it can be drawn."""
    try:
        from matplotlib.figure import Figure  # takes its time to import
    except ModuleNotFoundError:
        raise UsageError(f"{place}: pictures need matplotlib, which is not installed") from None
    form = path.suffix.lower().lstrip(".")
    figure = Figure()
    known = figure.canvas.get_supported_filetypes()
    if form not in known:
        allowed = ", ".join(f".{name}" for name in sorted(known))
        raise UsageError(f"{place}: the name of a picture must end in one of {allowed}")
    try:
        figure.savefig(io.BytesIO(), format=form)
    except Exception as error:  # for want of a program or package that this form needs
        problem = f"{place}: cannot be drawn as {known[form]}: {reason(error)}"
        raise UsageError(problem.replace("\n", " ")) from None
