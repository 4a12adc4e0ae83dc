"""Long work in slices."""

from collections.abc import Iterator

from sfd_hbm_ros.node import slices


def test_work_is_done_whole_in_slices_of_the_given_length(monkeypatch):
    clock, done = [0.0], []
    monkeypatch.setattr(slices.time, "monotonic", lambda: clock[0])

    def work() -> Iterator[None]:
        for step in range(10):
            clock[0] += 0.4 * slices.SLICE
            done.append(step)
            yield

    steps, progress = work(), []
    while slices.advance(steps):
        progress.append(len(done))
    assert progress == [3, 6, 9]
    assert done == list(range(10))
    assert not slices.advance(steps)
