"""The exception of a command that found no solution."""


class NoSolutionError(RuntimeError):
    """The input was good and the machine has no solution there, or none was found."""
