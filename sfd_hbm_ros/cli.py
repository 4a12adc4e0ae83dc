"""The command line: `python3 -m sfd_hbm_ros VERB ...`, or `sfd_hbm VERB ...`.

Exit status 0 with the result on standard output; 2 with one sentence on standard error for bad
input; 1 with one sentence where no solution was found; 130 where the user has interrupted.
"""

import argparse
import sys
from collections.abc import Sequence
from typing import NoReturn

from sfd_hbm_ros.commands import modes, paper, simulate, solve, study, sweep
from sfd_hbm_ros.machine import MachineError
from sfd_hbm_ros.response.curves.curve import NoSolutionError
from sfd_hbm_ros.study.results import IncompleteError

VERBS = {
    "solve": solve,
    "sweep": sweep,
    "study": study,
    "simulate": simulate,
    "modes": modes,
    "paper": paper,
}


class _Parser(argparse.ArgumentParser):
    """A parser that refuses in one sentence."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message}\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one verb and return the exit status."""
    parser = _Parser(
        prog="sfd_hbm", description="Rotors on squeeze film dampers by harmonic balance."
    )
    verbs = parser.add_subparsers(dest="verb", required=True, metavar="VERB")
    for name, verb in VERBS.items():
        summary = (verb.__doc__ or "").splitlines()[0]
        options = verbs.add_parser(name, help=summary, description=summary)
        verb.add_options(options)
    chosen = parser.parse_args(arguments)
    try:
        VERBS[chosen.verb].run(chosen)
    except BrokenPipeError:  # the reader of a pipe has seen enough
        sys.stderr.close()
    except (MachineError, ValueError, OSError, ModuleNotFoundError) as error:
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
