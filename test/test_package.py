"""The package as such: what it declares, imports and installs."""

import ast
import filecmp
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path

import pytest

from sfd_hbm_ros import __version__

ROOT = Path(__file__).parents[1]
MANIFEST = ET.parse(ROOT / "package.xml").getroot()
KEYED = ("matplotlib", "numba", "numpy", "scipy", "yaml")
ROSDEP_KEYS = {name: f"python3-{name}" for name in KEYED}
PAPER = str(ROOT / "config" / "paper_rotor.yaml")
HEAVY = ("matplotlib", "scipy.optimize", "scipy.interpolate", "dask", "pyarrow")
ROS_MODULE = re.compile(r"rclpy|rcl_interfaces|ament_index_python|launch\w*|\w+_(msgs|srvs)")


def imported(path: Path) -> Iterator[str]:
    """Top-level names of all that a file imports, wherever in it."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            yield node.module.partition(".")[0]


def outside_node(folder: str) -> list[Path]:
    paths = (ROOT / folder).rglob("*.py")
    return [path for path in paths if "node" not in path.relative_to(ROOT).parts]


@pytest.fixture
def prefix() -> Path:
    """Where ROS finds the built package."""
    for entry in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
        if Path(entry, "share/ament_index/resource_index/packages/sfd_hbm_ros").is_file():
            return Path(entry)
    pytest.skip("sfd_hbm_ros is not built and sourced")


def test_setup_py_and_package_xml_agree() -> None:
    command = [sys.executable, "setup.py", "--name", "--version", "--license"]
    printed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    assert printed.split() == [MANIFEST.findtext(tag) for tag in ("name", "version", "license")]
    assert __version__ == MANIFEST.findtext("version")


def test_every_import_is_declared() -> None:
    imports = {name for path in (ROOT / "sfd_hbm_ros").rglob("*.py") for name in imported(path)}
    needed = imports - set(sys.stdlib_module_names) - {"sfd_hbm_ros"}
    declared = {element.text for element in MANIFEST.iter("exec_depend")}
    assert {ROSDEP_KEYS.get(name, name) for name in needed} <= declared


@pytest.mark.parametrize("folder", ["sfd_hbm_ros", "test"])
def test_only_node_imports_ros(folder: str) -> None:
    importers = {
        str(path.relative_to(ROOT)): name
        for path in outside_node(folder)
        for name in imported(path)
        if ROS_MODULE.fullmatch(name)
    }
    assert importers == {}


def test_all_but_node_works_without_ros() -> None:
    modules = [
        ".".join(path.relative_to(ROOT).with_suffix("").parts)
        for path in outside_node("sfd_hbm_ros")
        if path.stem not in ("__init__", "__main__")
    ]
    assert "sfd_hbm_ros.cli" in modules
    # None in sys.modules is how Python is told that a module cannot be imported.
    script = f"""if True:
        import importlib, sys
        sys.modules["rclpy"] = None
        for module in {modules}:
            importlib.import_module(module)
    """
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("arguments", "absent"),
    [
        (["--help"], (*HEAVY, "numpy", "yaml")),
        (["modes", PAPER], (*HEAVY, "numba")),
        (["solve", PAPER, "--rpm", "3000"], HEAVY),
        (["sweep", PAPER, "--rpm", "3000:3100"], HEAVY),
    ],
)
def test_verb_imports_only_what_it_needs(arguments: list[str], absent: tuple[str, ...]) -> None:
    assert imported_by(f"from sfd_hbm_ros.cli import main; main({arguments})", absent) == set()


@pytest.mark.parametrize("module", ["predictor", "worker.process"])
def test_node_imports_only_what_it_needs(module: str) -> None:
    """A node that takes no more memory than it must runs on a small computer."""
    if module == "predictor":
        pytest.importorskip("rclpy")
    assert imported_by(f"import sfd_hbm_ros.node.{module}", (*HEAVY, "numba")) == set()


def imported_by(script: str, modules: tuple[str, ...]) -> set[str]:
    """Which of some modules a process has imported by the end of a script."""
    told = f"print(*(name for name in {modules} if name in sys.modules), file=sys.stderr)"
    script = f"import atexit, sys; atexit.register(lambda: {told}); {script}"
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return set(done.stderr.splitlines()[-1].split())  # before it a verb says that it is at work


@pytest.mark.parametrize("folder", ["config", "launch", "sros2"])
def test_ros_finds_files(prefix: Path, folder: str) -> None:
    share = prefix / "share" / "sfd_hbm_ros"
    assert (share / "package.xml").is_file()
    names = [path.name for path in (ROOT / folder).iterdir()]
    same, _, _ = filecmp.cmpfiles(ROOT / folder, share / folder, names, shallow=False)
    assert sorted(same) == sorted(names)
