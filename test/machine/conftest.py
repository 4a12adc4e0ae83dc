from pathlib import Path
from typing import Any

import pytest
import yaml

from sfd_hbm_ros.machine import Machine, machine_from_dict


@pytest.fixture(scope="session")
def paper_file() -> Path:
    return Path(__file__).parents[2] / "config" / "paper_rotor.yaml"


@pytest.fixture(scope="session")
def paper_data(paper_file: Path) -> dict[str, Any]:
    """The example as any YAML 1.1 reader sees it, some of its numbers being text."""
    data: dict[str, Any] = yaml.safe_load(paper_file.read_text(encoding="utf-8"))
    return data


@pytest.fixture(scope="session")
def paper(paper_data: dict[str, Any]) -> Machine:
    return machine_from_dict(paper_data)
