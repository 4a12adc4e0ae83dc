"""Errors of studies."""


class StudyError(ValueError):
    """A study that cannot be, or that its files do not let be, in one sentence."""


class IncompleteError(RuntimeError):
    """Variants are left without an outcome, as the processes that computed them were lost."""
