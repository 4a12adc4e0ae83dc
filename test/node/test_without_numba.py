"""A predictor whose Python has no Numba."""

from .graph import Remote  # first, as it skips the file without ROS

# isort: split
import os

from .process import PAPER_ROTOR, ROOT

SLOW = 120.0  # s, on a computer that is busy with other tests
VALUES = {
    "machine_file": PAPER_ROTOR,
    "harmonics": 1,
    "stale_after": 3600.0,
    "speed.min": 300.0,
    "speed.max": 310.0,
    "curve.detached": False,
}


def test_it_predicts_and_says_once_why_it_is_slow(graph, start_node, tmp_path, monkeypatch):
    (tmp_path / "sitecustomize.py").write_text("import sys; sys.modules['numba'] = None")
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}{os.pathsep}{ROOT}")
    given = (word for name, value in VALUES.items() for word in ("-p", f"{name}:={value}"))
    node = start_node("predictor", "--ros-args", *given)
    remote = Remote(graph)
    remote.meet(305.0)
    graph.until(
        lambda: remote.curves,
        "the worker, without Numba too, computes a curve",
        lambda: remote.send(305.0, remote.now()),
        SLOW,
    )
    said = node.said()
    assert said.count("Numba cannot be imported") == 1
    assert "the numerical kernels run uncompiled, some 10 to 40 times slower; install it" in said
    assert node.running
