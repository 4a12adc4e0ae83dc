"""Compiled kernels: kept on disk where that is possible, and of use where it is not."""

import gc
import importlib
import inspect
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
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


PAPER = str(ROOT / "config" / "paper_rotor.yaml")
SENTENCE = (
    "sfd_hbm: Numba cannot be imported (import of numba halted; None in sys.modules), so the "
    "numerical kernels run uncompiled, some 10 to 40 times slower; install it with 'apt install "
    "python3-numba' or 'pip install numba'"
)


@pytest.fixture
def without_numba(tmp_path: Path) -> dict[str, str]:
    """The environment of processes, and of those that they start, that cannot import Numba."""
    folder = tmp_path / "without"
    folder.mkdir()
    (folder / "sitecustomize.py").write_text("import sys; sys.modules['numba'] = None")
    return os.environ | {"PYTHONPATH": f"{folder}{os.pathsep}{ROOT}"}


def command(environment: dict[str, str], *words: str) -> tuple[str, list[str]]:
    """What a command prints, and the lines that it says about it."""
    done = subprocess.run(
        [sys.executable, "-m", "sfd_hbm_ros", *words],
        env=environment,
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout, [line for line in done.stderr.splitlines() if "at work" not in line]


def numbers_in(printed: object) -> list[float]:
    """All numbers of a result but its time."""
    if isinstance(printed, dict):
        printed = [value for key, value in printed.items() if key != "seconds"]
    if isinstance(printed, list):
        return [number for one in printed for number in numbers_in(one)]
    return [float(printed)] if isinstance(printed, int | float) else []


@pytest.mark.parametrize("machine", ["circular orbit", "gravity", "cavitation off"])
def test_without_numba_results_are_the_same(machine: str, without_numba: dict[str, str]) -> None:
    """And one sentence says why they take so long."""
    changes = {
        "circular orbit": [],
        "gravity": ["--set", "gravity=true"],
        "cavitation off": ["--set", "dampers.damper_1.film.cavitation=false"],
    }
    words = ["solve", PAPER, "--rpm", "3900", "--harmonics", "2", "--json", *changes[machine]]
    (plain, said), (compiled, _) = (
        command(without_numba, *words),
        command(dict(os.environ), *words),
    )
    assert said == [SENTENCE]
    found, expected = numbers_in(json.loads(plain)), numbers_in(json.loads(compiled))
    assert len(expected) > 10
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-9)


def test_without_numba_a_study_says_so_once(without_numba: dict[str, str], tmp_path: Path) -> None:
    vary = ["--vary", "dampers.damper_1.viscosity=0.027:0.028:2"]
    speeds = ["--rpm", "3000:3010", "--harmonics", "1"]
    table = ["--output", str(tmp_path / "table.csv")]
    _, said = command(without_numba, "study", PAPER, *speeds, *vary, *table)
    assert said.count(SENTENCE) == 1
    assert not [line for line in said if "Numba" in line and line != SENTENCE]


def test_arithmetic_without_numba_is_that_of_machine_code(tmp_path: Path) -> None:
    """A division by zero, the root of a negative number and an overflow have results."""
    script = """
import sys
sys.modules["numba"] = None if len(sys.argv) > 1 else __import__("numba")
import math
from sfd_hbm_ros.kernels import kernel, part

@part
def inverse(x):
    return 1.0 / x

@kernel("float64[::1](float64, float64[::1])")
def odd(x, out):
    z = complex(x, x)
    out[0], out[1], out[2] = inverse(x), math.sqrt(x - 1.0), (x - 1e200) ** 2
    out[3], out[4], out[5] = math.log(x), (1.0 / z.real), math.atan2(x, -1.0)
    return out

import warnings; warnings.simplefilter("ignore")
import numpy as np
print(odd(0.0, np.zeros(6)))
"""
    (tmp_path / "odd.py").write_text(script)
    printed = [
        subprocess.run(
            [sys.executable, tmp_path / "odd.py", *words],
            env=os.environ | {"PYTHONPATH": str(ROOT)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for words in ([], ["without"])
    ]
    assert printed[0] == printed[1]
    assert "inf" in printed[0]
    assert "nan" in printed[0]


def test_what_the_scripts_compile_exists_afterwards(tmp_path: Path) -> None:
    """In a copy of the package that has been compiled nowhere, with a ROS 2 that is sourced."""
    pytest.importorskip("rclpy")
    pytest.importorskip("colcon_core")
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "sfd_hbm_ros", tmp_path / "sfd_hbm_ros", ignore=ignored)
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"}
    environment |= {"ROS_DISTRO": "jazzy", "PYTHONPATH": str(tmp_path)}
    environment["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{environment['PATH']}"
    told = [
        subprocess.run(
            ["bash", "-euc", f". '{ROOT}/scripts/environment.sh'; compile_kernels"],
            env=environment,
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for _ in range(2)
    ]
    source = "".join(path.read_text() for path in (tmp_path / "sfd_hbm_ros").rglob("*.py"))
    number = len(re.findall(r"^@kernel\(", source, re.MULTILINE))
    assert number > 10
    assert len(list(tmp_path.rglob("*.nbi"))) == number
    assert len(list(tmp_path.rglob("*.nbc"))) == number
    assert told == ["Compiling the numerical kernels (once, about 10 s) ...\n", ""]
