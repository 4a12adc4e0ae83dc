"""Environments in which the peers live, each with the Python and the packages that it wants."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.peers.problem import ROOT

CACHE = ROOT / ".benchmarks"
OWN = ("numpy", "scipy", "pyyaml", "numba")  # what the film needs, which peers call
NEWEST = 14  # minor version of the newest Python that is looked for
PATIENCE = 900.0  # s that a peer may take to install, and then to run


class UnavailableError(RuntimeError):
    """A peer cannot be installed or does not run; the message says why in a few words."""


@dataclass(frozen=True)
class Peer:
    """Another solver, from PyPI.

    Attributes
    ----------
    name : str
        The distribution.
    version : str
        The version that the benchmark was written for.
    module : str
        Module of this package that is run in the peer's environment. It reads the problem from
        its standard input and writes the result to its standard output, both JSON.
    python : int
        Minor version of the oldest Python 3 that it runs on.
    """

    name: str
    version: str
    module: str
    python: int = 11

    @property
    def requirement(self) -> str:
        """The distribution as pip wants it."""
        return f"{self.name}=={self.version}"

    def run(self, problem: dict[str, Any]) -> Any:
        """What the peer makes of a problem; it is installed first, where it is not yet.

        Raises
        ------
        UnavailableError
            If it cannot be installed or does not run.
        """
        folder = CACHE / self.name
        if not (folder / "complete").exists():
            self._install(folder)
        environment = {name: v for name, v in os.environ.items() if name != "PYTHONPATH"}
        environment |= {"OPENBLAS_NUM_THREADS": "1", "NUMBA_CACHE_DIR": str(folder / "numba")}
        command = [str(folder / "bin" / "python"), "-m", f"{__package__}.{self.module}"]
        done = _finished(command, environment, json.dumps(problem))
        if done.returncode:
            raise UnavailableError(f"fails: {_last_line(done.stderr)}")
        return json.loads(done.stdout.splitlines()[-1])  # import prints too

    def _install(self, folder: Path) -> None:
        python = _python(self.python)
        made = _finished([python, "-m", "venv", "--clear", str(folder)])
        if made.returncode:
            raise UnavailableError(f"no virtual environment: {_last_line(made.stderr)}")
        pip = [str(folder / "bin" / "python"), "-m", "pip", "--disable-pip-version-check"]
        done = _finished([*pip, "install", "--quiet", *OWN, self.requirement])
        if done.returncode:
            raise UnavailableError(f"pip cannot install it: {_last_line(done.stderr)}")
        (folder / "complete").touch()


def _python(minor: int) -> str:
    """An interpreter of Python 3 that is recent enough, preferably the one that is running."""
    if sys.version_info >= (3, minor):
        return sys.executable
    for candidate in _candidates(minor):
        try:
            if not _finished([candidate, "-c", "import venv"]).returncode:
                return candidate
        except OSError:
            continue
    raise UnavailableError(f"needs Python 3.{minor}, which was not found")


def _candidates(minor: int) -> Iterator[str]:
    """Interpreters that may exist: on the path, and those that pyenv has installed."""
    versions = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    for newer in range(minor, NEWEST + 1):
        yield f"python3.{newer}"
        yield from map(str, sorted(versions.glob(f"3.{newer}.*/bin/python")))


def _finished(
    command: list[str], environment: dict[str, str] | None = None, text: str = ""
) -> subprocess.CompletedProcess[str]:
    try:
        return subprocess.run(
            command,
            cwd=ROOT,
            env=environment,
            input=text,
            capture_output=True,
            text=True,
            timeout=PATIENCE,
        )
    except subprocess.TimeoutExpired:
        raise UnavailableError(f"takes longer than {PATIENCE:g} s") from None


def _last_line(text: str) -> str:
    return (text.strip().splitlines() or ["without a message"])[-1]
