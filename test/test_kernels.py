"""Compiled kernels: kept on disk where that is possible, and of use where it is not."""

import gc
import importlib
import inspect
import os
import subprocess
import sys
from pathlib import Path

from numba.core.dispatcher import Dispatcher

from sfd_hbm_ros import kernels

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


def printed_in(folder: Path, script: str = CUBE) -> str:
    """What a process prints that has no home and whose kernel stands in a folder."""
    (folder / "cube.py").write_text(script)
    homeless = {"HOME": os.devnull, "XDG_CACHE_HOME": os.devnull, "PYTHONPATH": str(ROOT)}
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"} | homeless
    done = subprocess.run(
        [sys.executable, folder / "cube.py"], env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_kernel_is_kept_beside_its_source(tmp_path: Path) -> None:
    assert printed_in(tmp_path) == "27.0\n"
    assert list(tmp_path.glob("__pycache__/cube.cube-*.nbi"))


def test_kernel_works_where_nothing_can_be_kept(tmp_path: Path) -> None:
    """A file in the cache's place keeps even root from making it."""
    (tmp_path / "__pycache__").touch()
    assert printed_in(tmp_path) == "27.0\n"


def test_kernels_call_nothing_of_other_files() -> None:
    """Numba looks for changes in a kernel's own file only."""
    paths = (ROOT / "sfd_hbm_ros").rglob("*.py")
    users = [path for path in paths if "sfd_hbm_ros.kernels import" in path.read_text()]
    names = [".".join(path.relative_to(ROOT).with_suffix("").parts) for path in users]
    modules = [importlib.import_module(name) for name in names]
    kernels.load_kernels()
    checked = 0
    for name, module in zip(names, modules, strict=True):
        for function in filter(is_compiled, vars(module).values()):
            called = [vars(module).get(one) for one in inspect.unwrap(function).__code__.co_names]
            assert {one.__module__ for one in called if is_compiled(one)} <= {name}
            checked += 1
    assert checked > 20


def test_what_is_loaded_is_spared_by_the_garbage_collector() -> None:
    gc.unfreeze()
    try:
        kernels.load_kernels()
        assert gc.get_freeze_count() > 10_000
        assert len(gc.get_objects()) < 1_000
    finally:
        gc.unfreeze()


def is_compiled(item: object) -> bool:
    """Whether it is a part, once compiled, or a kernel."""
    code = getattr(item, "__code__", None)
    return isinstance(item, Dispatcher) or bool(code and code.co_filename == kernels.__file__)


def test_kernel_is_loaded_at_its_first_call(tmp_path: Path) -> None:
    """With no collection of what Numba has made, and the collector as it was before."""
    watched = CUBE.replace("print(", "import gc, sys; print('numba' in sys.modules, ")
    watched += "print('numba' in sys.modules, gc.isenabled(), gc.get_stats()[2]['collections'])"
    assert printed_in(tmp_path, watched) == "False 27.0\nTrue True 0\n"
