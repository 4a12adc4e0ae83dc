"""Errors of studies."""


class IncompleteError(RuntimeError):
    """Variants are left without an outcome, as the processes that computed them were lost."""
