"""Our solver beside others: the same problem, the same tolerance, one run.

. scripts/environment.sh; python3 -m benchmarks.peers [CASE ...]

Prints how many times longer each peer takes, with the agreement of the results beside it. All
times are processor times of calls that have been made before. A peer is installed from PyPI into
an environment of its own below `.benchmarks/`; where that is not possible, its row says so.
"""

import argparse
from collections.abc import Callable, Iterator

from benchmarks.peers import duffing, harmonic_balance, initial_value, integration, newmark
from benchmarks.peers.environments import UnavailableError
from benchmarks.peers.problem import Row

CASES: dict[str, Callable[[], Iterator[Row]]] = {
    "pyharm": harmonic_balance.rows,
    "ross": newmark.rows,
    "solve_ivp": initial_value.rows,
    "contique": duffing.rows,
    "integrator": integration.rows,
}


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("case", nargs="*", choices=[*CASES, []], help="peers, by default all")
    chosen = parser.parse_args().case or CASES
    print("| work | peer | ratio | ours | the peer | agreement |\n|---|---|---|---|---|---|")
    for name in chosen:
        try:
            for row in CASES[name]():
                print(row, flush=True)
        except UnavailableError as error:
            print(f"| | {name} | | | | {error} |", flush=True)


if __name__ == "__main__":
    main()
