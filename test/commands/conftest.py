"""Fixtures for the tests of the command line."""

import pytest

from sfd_hbm_ros.commands import progress


@pytest.fixture(autouse=True)
def patient(monkeypatch):
    """No lines that tell that a command is still at work, however slow the computer is."""
    monkeypatch.setattr(progress, "_SILENCE", 1e6)
