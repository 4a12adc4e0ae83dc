"""The command line: `python3 -m sfd_hbm_ros VERB ...`, or `sfd_hbm VERB ...`.

Exit status 0 with the result on standard output; 2 with one sentence on standard error for bad
input; 1 with one sentence where no solution was found; 130 where the user has interrupted.
"""

import argparse
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import NoReturn

from sfd_hbm_ros.response.errors import NoSolutionError
from sfd_hbm_ros.study.errors import IncompleteError

VERBS = {
    "solve": "The response at one speed: eccentricity and harmonics of every damper.",
    "sweep": "The response over a range of speeds, or of any entry of the machine file at one.",
    "study": "Response curves of many variants of a machine: grids and Monte Carlo.",
    "simulate": "A run-up or coast-down in time, which shows by itself where the machine jumps.",
    "modes": "Critical speeds, or whirl modes at one speed, of the rotor without its films.",
    "paper": "The reference paper: its figures computed again, and its claims judged.",
}
"""What each verb does; its module in `commands` is imported when it is asked for."""


class _Parser(argparse.ArgumentParser):
    """A parser that refuses in one sentence."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message}\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one verb and return the exit status."""
    given = sys.argv[1:] if arguments is None else arguments
    parser = _Parser(
        prog="sfd_hbm", description="Rotors on squeeze film dampers by harmonic balance."
    )
    verbs = parser.add_subparsers(dest="verb", required=True, metavar="VERB")
    for name, summary in VERBS.items():
        options = verbs.add_parser(name, help=summary, description=summary)
        if name in given:
            verb = import_module(f"sfd_hbm_ros.commands.{name}")
            verb.add_options(options)
            options.set_defaults(run=verb.run)
    chosen = parser.parse_args(given)
    try:
        chosen.run(chosen)
    except BrokenPipeError:  # the reader of a pipe has seen enough
        sys.stderr.close()
    except (ValueError, OSError, ModuleNotFoundError) as error:
        return _refuse(parser.prog, error, 2)
    except (NoSolutionError, IncompleteError) as error:
        return _refuse(parser.prog, error, 1)
    except KeyboardInterrupt as interrupt:
        return _refuse(parser.prog, str(interrupt) or "interrupted", 130)
    return 0


def _refuse(program: str, error: Exception | str, status: int) -> int:
    print(f"{program}: {error}", file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main())
