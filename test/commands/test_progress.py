"""The lines that show progress."""

from sfd_hbm_ros.commands import progress
from sfd_hbm_ros.commands.progress import share_bar


def test_a_bar_of_what_is_done_with_the_time_left(monkeypatch):
    """Five variants were there before; the next ten take 20 s, so that 35 more take 70 s."""
    clock = iter((100.0, 120.0))
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(clock))
    line = share_bar(5, 50, "variants")(10, 0.0)
    assert line == f"[{'#' * 12}{'.' * 28}] 15 of 50 variants, 0:01:10 left"
