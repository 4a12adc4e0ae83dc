"""A study brought to its end, from wherever its journal left it."""

from collections.abc import Callable, Iterator

from sfd_hbm_ros.study.design import Design
from sfd_hbm_ros.study.errors import IncompleteError
from sfd_hbm_ros.study.journal import Journal
from sfd_hbm_ros.study.processes import Variants
from sfd_hbm_ros.study.results import Results
from sfd_hbm_ros.study.task import Outcome

Computer = Callable[[Variants], Iterator[tuple[int, Outcome]]]
"""What computes variants, and yields each with its number as it is ready."""


def complete(
    journal: Journal, design: Design, compute: Computer, progress: Callable[[float], None]
) -> Results:
    """Compute the variants that a journal lacks, and keep each in it as it comes.

    Parameters
    ----------
    journal : Journal
        The journal of the study.
    design : Design
        The study's variants.
    compute : callable
        What computes variants.
    progress : callable
        Called with the number of each variant that has been computed.

    Raises
    ------
    IncompleteError
        If processes were lost, and variants with them.
    KeyboardInterrupt
        With a sentence, if the user has interrupted.
    """
    outcomes, total = journal.outcomes, len(design)
    rows = enumerate(design.values.tolist())
    lacking = {number: row for number, row in rows if number not in outcomes}
    try:
        for number, outcome in compute(lacking) if lacking else ():
            journal.add(number, outcome)
            progress(number)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(
            f"interrupted: {len(outcomes)} of {total} variants are in {journal.path}; the same "
            "command goes on"
        ) from None
    if len(outcomes) < total:
        raise IncompleteError(
            f"{total - len(outcomes)} of {total} variants were not computed, as the processes at "
            "them died; the same command tries them again"
        )
    return Results(design, [outcomes[number] for number in range(total)])
