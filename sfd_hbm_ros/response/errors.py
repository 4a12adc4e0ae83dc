"""Errors of the rooms that ask for responses."""


class NoSolutionError(RuntimeError):
    """The machine has no solution where one was asked for, or none was found."""
