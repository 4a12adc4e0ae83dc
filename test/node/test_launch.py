"""The launch files name what exists: launch itself is not needed to see that."""

import re
from pathlib import Path
from typing import Any

import pytest
import yaml

pytest.importorskip("rclpy")

from sfd_hbm_ros.node.schema import SCHEMA

from .process import ROOT

FILES = sorted((ROOT / "launch").iterdir())
HERE = re.compile(r"\$\(find-pkg-share sfd_hbm_ros\)/(\S+)")


def entries(file: Path, kind: str) -> list[dict[str, Any]]:
    actions = yaml.safe_load(file.read_text())["launch"]
    return [action[kind] for action in actions if kind in action]


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_arguments_files_nodes_and_parameters_exist(file):
    text = file.read_text()
    arguments = {argument["name"] for argument in entries(file, "arg")}
    assert set(re.findall(r"\$\(var (\w+)\)", text)) == arguments
    assert [name for name in HERE.findall(text) if not (ROOT / name).is_file()] == []
    for include in entries(file, "include"):
        given = {argument["name"] for argument in include["arg"]}
        other = ROOT / HERE.fullmatch(include["file"])[1]
        assert given <= {argument["name"] for argument in entries(other, "arg")}
    for node in entries(file, "node"):
        assert f"{node['exec']} = {{package}}.node" in (ROOT / "setup.py").read_text()
        if node["exec"] == "predictor":
            named = {given["name"] for given in node["param"] if "name" in given}
            assert named <= {spec.name for spec in SCHEMA}
    assert entries(file, "node") or entries(file, "include")


def test_launch_file_and_demo_play_the_same_machine_with_the_same_alarm():
    """The paper's rotor, with that unbalance at which it jumps."""
    demo = (ROOT / "scripts" / "demo.sh").read_text()
    simulation = ROOT / "launch" / "simulation.launch.yaml"
    [played] = set(re.findall(r"config/(\w+rotor\.yaml)", demo + simulation.read_text())) | set(
        re.findall(r'"\$config/(\w+rotor\.yaml)"', demo)
    )
    assert "alarm." not in demo + simulation.read_text()
    jumping, paper = (
        yaml.safe_load((ROOT / "config" / name).read_text())
        for name in (played, "paper_rotor.yaml")
    )
    assert jumping["unbalance"] == [{"station": "disk_2", "magnitude": 5.039e-4, "phase": 0.0}]
    named = {key: paper[key] for key in ("name", "unbalance")}
    assert {**jumping, **named} == {**paper, "operating_speed_rpm": [1900.0, 6100.0]}
