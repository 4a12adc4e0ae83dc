"""Errors of the rooms that ask for responses."""


class NoSolutionError(RuntimeError):
    """The machine has no solution where one was asked for, or none was found."""


def unexpected(error: Exception) -> str:
    """Say that an error is none that the program knows of."""
    return f"unexpected error in the program, {type(error).__name__}: {error}"
