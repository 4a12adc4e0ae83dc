"""Where the machine files and settings lie that come with the package."""

from pathlib import Path


def shipped(name: str) -> Path:
    """Return a file of the folder config, in the source tree or where the package is installed.

    Raises
    ------
    FileNotFoundError
        If it is in neither.
    """
    for parent in Path(__file__).resolve().parents:
        for folder in (parent / "config", parent / "share" / "sfd_hbm_ros" / "config"):
            if (folder / name).is_file():
                return folder / name
    raise FileNotFoundError(f"{name} is not installed beside the package")
