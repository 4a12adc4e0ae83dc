"""Tables of numbers as CSV."""

import csv
from collections.abc import Iterable
from pathlib import Path
from typing import Any


def write_csv(path: str | Path, header: Iterable[str], rows: Iterable[Iterable[Any]]) -> None:
    """Write a table as CSV, numbers in full precision and nothing for None.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)
