"""How a peer's module talks to the benchmark: problem in, result out, as JSON."""

import contextlib
import json
import sys
from collections.abc import Callable
from typing import Any


def answer(solve: Callable[..., dict[str, Any]]) -> None:
    """Write to standard output what a function makes of the problem on standard input.

    What the peer itself prints goes to standard error.
    """
    problem = json.load(sys.stdin)
    with contextlib.redirect_stdout(sys.stderr):
        result = solve(**problem)
    json.dump(result, sys.stdout)
