"""From nothing to the first solution: processor time and memory of fresh processes, in stages.

. scripts/environment.sh; python3 -m benchmarks.start [--cold]

Every row is a process of its own, run several times in turn with the others; the least processor
time counts. Ratios are to the bare libraries: NumPy, scipy.linalg, and Numba with one kernel of
one addition, kept on disk. With --cold, the first solution after an installation, too.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
MACHINE = ROOT / "config" / "paper_rotor.yaml"
RUNS = 5

# Numba imports coverage where there is one, as beside the tests, and not with a user.
WITHOUT_COVERAGE = "import sys; sys.modules['coverage'] = None\n"
KERNEL = """
import numba

@numba.jit("float64(float64)", nopython=True, cache=True)
def increased(x):
    return x + 1.0
"""
LIBRARIES = "import numpy, scipy.linalg; "
BARE = f"{LIBRARIES} import bare_kernel"
ROTOR = f"""
from sfd_hbm_ros.machine import read_machine
from sfd_hbm_ros.hbm import HarmonicBalance, Harmonics, solve, stability
balance = HarmonicBalance(read_machine({str(MACHINE)!r}), Harmonics(7))
solution = solve(balance, 314.0)
assert solution.converged and stability(balance, solution).stable
"""
CURVE = f"""{ROTOR}
from sfd_hbm_ros.response.curves.curve import response_curve
response_curve(balance, 209.0, 628.0)
"""
VERB = """
import contextlib, io
from sfd_hbm_ros.cli import main
with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):
    main({})
"""
ROS = "import rclpy.lifecycle, sensor_msgs.msg, diagnostic_msgs.msg, geometry_msgs.msg; "
NODE = f"""{ROS}
rclpy.init()
node = rclpy.lifecycle.LifecycleNode("bare")
publisher = node.create_publisher(sensor_msgs.msg.JointState, "~/bare", 1)
"""
PREDICTOR = """
import sfd_hbm_ros.node.predictor
from sfd_hbm_ros.kernels import load_kernels
load_kernels()
"""
STAGES = {
    "Python": "pass",
    "NumPy, scipy.linalg": LIBRARIES,
    "NumPy, scipy.linalg, Numba": f"{LIBRARIES} import numba",
    "the same and one kernel": BARE,
    "sfd_hbm_ros.hbm imported": "import sfd_hbm_ros.hbm",
    "and the first solution": ROTOR,
    "and the whole curve": CURVE,
    "--help": VERB.format(["--help"]),
    "modes": VERB.format(["modes", str(MACHINE)]),
    "solve": VERB.format(["solve", str(MACHINE), "--rpm", "3000"]),
    "a bare node": NODE,
    "a bare node and one kernel": f"{NODE}{BARE}",
    "a bare node and the predictor's code": f"{NODE}{PREDICTOR}",
}
FLOOR = "the same and one kernel"
REPORT = """
import json, re, time
used = time.process_time()
memory = open("/proc/self/smaps_rollup").read()
found = [re.search(rf"^{key}: +([0-9]+)", memory, re.M) for key in ("Rss", "Anonymous")]
print(json.dumps([used, *(int(one[1]) / 1024.0 for one in found)]))
"""


class Start(NamedTuple):
    """What a process has used.

    Attributes
    ----------
    cpu : float
        Processor time [s].
    resident : float
        Resident memory, with the files that are mapped into it [MiB].
    own : float
        The part of it that no file holds [MiB].
    """

    cpu: float
    resident: float
    own: float


def started(script: str, folder: Path, **environment: str) -> Start | None:
    """Run a script in a process of its own; nothing where it lacks a module, such as rclpy."""
    given = {"PYTHONPATH": str(folder)} | environment
    command = [sys.executable, "-c", WITHOUT_COVERAGE + script + REPORT]
    done = subprocess.run(
        command, env=os.environ | given, cwd=ROOT, capture_output=True, text=True
    )
    if "ModuleNotFoundError" in done.stderr:
        return None
    if done.returncode:
        raise RuntimeError(done.stderr)
    return Start(*json.loads(done.stdout.splitlines()[-1]))


def table(best: dict[str, Start]) -> list[str]:
    """The lines of the result."""
    width = max(map(len, best))
    lines = [f"{'':{width}}  CPU [s]  ratio  resident [MiB]  ratio  own [MiB]"]
    floor = best[FLOOR]
    for name, one in best.items():
        cpu = f"{one.cpu:7.2f} {one.cpu / floor.cpu:6.2f}"
        resident = f"{one.resident:14.1f} {one.resident / floor.resident:6.2f}"
        lines.append(f"{name:{width}}  {cpu}  {resident} {one.own:10.1f}")
    return lines


def main() -> None:
    """Run all stages and print."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--cold", action="store_true", help="compile all kernels once, too")
    cold = parser.parse_args().cold
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "bare_kernel.py").write_text(KERNEL)
        for script in (BARE, CURVE):  # so that all kernels are kept
            started(script, folder)
        best: dict[str, Start] = {}
        for _ in range(RUNS):
            for stage, script in STAGES.items():
                if (one := started(script, folder)) is not None:
                    best[stage] = min(one, best.get(stage, one))
        if cold and (one := started(ROTOR, folder, NUMBA_CACHE_DIR=str(folder))) is not None:
            best["the first solution, nothing kept"] = one
    print("\n".join(table(best)))


if __name__ == "__main__":
    main()
