"""A run in time as a table of numbers."""

from pathlib import Path

import numpy as np

from sfd_hbm_ros.report.csv_file import write_csv
from sfd_hbm_ros.response.integration.transient import Transient
from sfd_hbm_ros.units import RPM


def write_transient(transient: Transient, path: str | Path) -> None:
    """Write a run as CSV, one row a revolution.

    Columns are the time [s] and the speed [rpm] in the middle of the revolution, and the greatest
    and the mean eccentricity of each damper in it.

    Parameters
    ----------
    transient : Transient
        The run.
    path : str or Path
        The file.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    columns = {"time_s": transient.time, "speed_rpm": transient.speed / RPM}
    for name, greatest in transient.eccentricity_max.items():
        columns[f"{name}.eccentricity_max"] = greatest
        columns[f"{name}.eccentricity_mean"] = transient.eccentricity_mean[name]
    write_csv(path, columns, np.column_stack(list(columns.values())).tolist())
