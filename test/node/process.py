"""A node as a process of its own."""

import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).parents[2]
PAPER_ROTOR = ROOT / "config" / "paper_rotor.yaml"


def parameters_of(file: Path) -> dict[str, Any]:
    """Return the parameters that a file gives to every node, by their dotted names."""
    nested = yaml.safe_load(file.read_text())["/**"]["ros__parameters"]
    return {
        f"{name}.{key}" if key else name: value
        for name, entry in nested.items()
        for key, value in (entry.items() if isinstance(entry, dict) else [("", entry)])
    }


class NodeProcess:
    """A node, started with arguments; what it prints and logs goes to a file."""

    def __init__(self, module: str, *arguments: str) -> None:
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 - end() closes it
        command = [sys.executable, "-m", f"sfd_hbm_ros.node.{module}", *arguments]
        self._process = subprocess.Popen(
            command, cwd=ROOT, stdout=self._errors, stderr=subprocess.STDOUT
        )

    @property
    def running(self) -> bool:
        return self._process.poll() is None

    @property
    def pid(self) -> int:
        return self._process.pid

    def send(self, number: signal.Signals) -> None:
        """Send a signal."""
        self._process.send_signal(number)

    def stop(self, number: signal.Signals) -> int:
        """Send a signal and return the exit code."""
        self.send(number)
        return self.wait(20.0)

    def wait(self, limit: float) -> int:
        """Wait [s] until it ends by itself and return the exit code."""
        return self._process.wait(timeout=limit)

    def end(self) -> None:
        """End it if it still runs, with its socket and memory files if it can."""
        if self.running:
            self._process.terminate()
            try:
                self._process.wait(timeout=10.0)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._errors.close()

    def said(self) -> str:
        """Everything printed so far."""
        # At no file position: that one belongs to the process, too.
        return os.pread(self._errors.fileno(), 1 << 24, 0).decode()
