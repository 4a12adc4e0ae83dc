"""Compiled kernels: kept on disk where that is possible, and of use where it is not."""

import importlib
import os
import subprocess
import sys
from pathlib import Path

from numba.core.dispatcher import Dispatcher

ROOT = Path(__file__).parents[1]
CUBE = """
from sfd_hbm_ros.kernels import kernel, part

@part
def square(x):
    return x * x

@kernel("float64(float64)")
def cube(x):
    return x * square(x)

print(cube(3.0))
"""


def cube_in(folder: Path) -> str:
    """What a process prints that has no home and whose kernel stands in a folder."""
    (folder / "cube.py").write_text(CUBE)
    homeless = {"HOME": os.devnull, "XDG_CACHE_HOME": os.devnull, "PYTHONPATH": str(ROOT)}
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"} | homeless
    done = subprocess.run(
        [sys.executable, folder / "cube.py"], env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_kernel_is_kept_beside_its_source(tmp_path: Path) -> None:
    assert cube_in(tmp_path) == "27.0\n"
    assert list(tmp_path.glob("__pycache__/cube.cube-*.nbi"))


def test_kernel_works_where_nothing_can_be_kept(tmp_path: Path) -> None:
    """A file in the cache's place keeps even root from making it."""
    (tmp_path / "__pycache__").touch()
    assert cube_in(tmp_path) == "27.0\n"


def test_kernels_call_nothing_of_other_files() -> None:
    """Numba looks for changes in a kernel's own file only."""
    checked = 0
    for path in (ROOT / "sfd_hbm_ros").rglob("*.py"):
        if "sfd_hbm_ros.kernels import" not in path.read_text():
            continue
        name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
        module = importlib.import_module(name)
        for function in filter(lambda one: isinstance(one, Dispatcher), vars(module).values()):
            called = [vars(module).get(one) for one in function.py_func.__code__.co_names]
            compiled = [one for one in called if isinstance(one, Dispatcher)]
            assert {one.py_func.__module__ for one in compiled} <= {name}
            checked += 1
    assert checked > 3
