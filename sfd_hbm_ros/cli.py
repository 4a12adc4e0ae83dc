"""The command line: `python3 -m sfd_hbm_ros VERB ...`, or `sfd_hbm VERB ...`.

Exit status 0 with the result on standard output; 2 with one sentence on standard error for bad
input and for files that cannot be read or written; 1 with one sentence where no solution was
found; 130 where the user has interrupted; 70 for an error of the program itself, of which a file
keeps the traceback. Warnings go to standard error and change no status.
"""

import argparse
import sys
import tempfile
import traceback
import warnings
from collections.abc import Sequence
from importlib import import_module
from typing import NoReturn

from sfd_hbm_ros.commands.progress import at_work
from sfd_hbm_ros.threads import one_blas_thread

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
        with at_work(chosen.verb), warnings.catch_warnings(), one_blas_thread:
            # where numbers overflow, the outcome tells
            warnings.simplefilter("ignore", RuntimeWarning)
            warnings.showwarning = lambda message, *_: print(
                f"sfd_hbm: {message}", file=sys.stderr
            )
            chosen.run(chosen)
    except BrokenPipeError:  # the reader of a pipe has seen enough
        sys.stderr.close()
    except KeyboardInterrupt as interrupt:
        return _end(parser.prog, str(interrupt) or "interrupted", 130)
    except Exception as error:
        return _end(parser.prog, *_told(error, given))
    return 0


def _end(program: str, sentence: str, status: int) -> int:
    print(f"{program}: {' '.join(sentence.split())}", file=sys.stderr)
    return status


def _told(error: Exception, given: Sequence[str]) -> tuple[str, int]:
    """What a user is told of an error, and the exit status."""
    # imported here, as they take their time and the verb has imported them already
    from numpy.linalg import LinAlgError

    from sfd_hbm_ros.commands.arguments import UsageError
    from sfd_hbm_ros.hbm.options import OptionError
    from sfd_hbm_ros.machine import MachineError
    from sfd_hbm_ros.response.errors import NoSolutionError
    from sfd_hbm_ros.study.errors import IncompleteError, StudyError

    if isinstance(error, (UsageError, MachineError, OptionError, StudyError)):
        return str(error), 2
    if isinstance(error, OSError):
        return ": ".join(str(one) for one in (error.filename, error.strerror or error) if one), 2
    if isinstance(error, ModuleNotFoundError):
        return str(error), 2
    if isinstance(error, (NoSolutionError, IncompleteError)):
        return str(error), 1
    if isinstance(error, (ArithmeticError, LinAlgError)):
        return f"no solution: the numbers leave the range of the computer ({error})", 1
    if isinstance(error, MemoryError):
        return f"no solution: it takes more memory than there is ({error})", 1
    return _report(error, given), 70


def _report(error: Exception, given: Sequence[str]) -> str:
    """Keep an error's traceback in a file, and say where."""
    name = type(error).__name__
    lines = [f"sfd_hbm {' '.join(given)}", f"Python {sys.version}", traceback.format_exc()]
    try:
        with tempfile.NamedTemporaryFile(
            "w", prefix="sfd_hbm_report_", suffix=".txt", delete=False, encoding="utf-8"
        ) as file:
            file.write("\n".join(lines))
    except OSError:
        traceback.print_exc()
        return f"an error of the program itself, {name}: {error}; please report it with the above"
    return f"an error of the program itself, {name}: {error}; please report it with {file.name}"


if __name__ == "__main__":
    sys.exit(main())
