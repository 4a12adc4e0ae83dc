"""The command line as such: its verbs, how it refuses, and what it doubts."""

import json
import re
from pathlib import Path

import pytest

from sfd_hbm_ros import cli, commands
from sfd_hbm_ros.commands import modes

PAPER = str(Path(__file__).parents[2] / "config" / "paper_rotor.yaml")


def test_every_verb_is_offered() -> None:
    paths = Path(*commands.__path__).glob("*.py")
    assert {p.stem for p in paths if "def add_options(" in p.read_text()} == set(cli.VERBS)


@pytest.mark.parametrize("verb", cli.VERBS)
def test_every_verb_tells_what_it_does(verb: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="0"):
        cli.main([verb, "--help"])
    printed = " ".join(capsys.readouterr().out.split())
    assert printed.startswith(f"usage: sfd_hbm {verb} [-h]")
    assert cli.VERBS[verb] in printed


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ([], "sfd_hbm: the following arguments are required: VERB"),
        (["solv"], "sfd_hbm: argument VERB: invalid choice: 'solv' (choose from "),
        (["--rpm", "solve", "x.yaml"], "sfd_hbm solve: the following arguments are required: "),
    ],
)
def test_bad_arguments_are_refused_in_one_sentence(
    arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit, match="2"):
        cli.main(arguments)
    printed = capsys.readouterr().err
    assert printed.startswith(sentence)
    assert printed.count("\n") == 1


DAMPER = "dampers.damper_1"


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (
            f"{DAMPER}.diameter=76.2",
            f"{DAMPER}.diameter is 76.2 m, where 0.002 to 2.5 are usual: were 76.2 mm meant, "
            "which are 0.0762 m?",
        ),
        (
            f"{DAMPER}.viscosity=28",
            f"{DAMPER}.viscosity is 28 Pa s, where 1e-05 to 2 are usual: were 28 mPa s meant, "
            "which are 0.028 Pa s?",
        ),
        (f"{DAMPER}.clearance=0.0254", f"{DAMPER}.clearance is 0.0254 m, where "),
        ("materials.steel.youngs_modulus=207", "materials.steel.youngs_modulus is 207 Pa, where "),
        ("materials.steel.density=7.833", "materials.steel.density is 7.833 kg/m3, where 100 to "),
        ("shaft.0.length=25.4", "shaft.0.length is 25.4 m, where "),
        ("bearings.bearing_1.stiffness=[[1e8, 0], [0, 105]]", "bearings.bearing_1.stiffness is 1"),
        ("unbalance.bearing_1.magnitude=431.9", "unbalance.bearing_1.magnitude is 431.9 kg m, wh"),
        ("unbalance.disk_2.phase=90", "unbalance.disk_2.phase is 90 rad, where 0 to 6.3 are usu"),
    ],
)
def test_numbers_in_another_unit_are_doubted_and_computed(change, sentence, capsys):
    assert cli.main(["modes", PAPER, "--set", change, "--json"]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out)["critical_speeds"]
    assert err.startswith(f"sfd_hbm: warning: {sentence}")
    assert err.count("\n") == 1


@pytest.mark.parametrize("change", ["centering_stiffness=0", "density=0", "bearing_damping=0"])
def test_what_is_not_there_is_not_doubted(change, capsys):
    assert cli.main(["modes", PAPER, "--set", f"{DAMPER}.{change}"]) == 0
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("rpm", ["1e200", "1e308", "1e-300"])
@pytest.mark.parametrize("verb", ["solve", "sweep"])
def test_numbers_beyond_the_computer_are_no_solution(verb, rpm, capsys):
    speeds = rpm if verb == "solve" else f"{rpm}:{float(rpm) / 2}"
    assert cli.main([verb, PAPER, "--rpm", speeds]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("sfd_hbm: no solution")
    assert err.count("\n") == 1


def test_an_error_of_the_program_is_told_as_such_and_its_traceback_kept(monkeypatch, capsys):
    """No such error is known, so that one is put in."""

    def assemble(_):
        return {}["a key that is not there"]

    monkeypatch.setattr(modes, "assemble", assemble)
    assert cli.main(["modes", PAPER]) == 70
    _, err = capsys.readouterr()
    assert err.startswith("sfd_hbm: an error of the program itself, KeyError: 'a key that is not ")
    assert err.count("\n") == 1
    report = Path(re.search(r"please report it with (.+)\n", err)[1])
    text = report.read_text(encoding="utf-8")
    report.unlink()
    assert f"modes {PAPER}" in text
    assert 'return {}["a key that is not there"]' in text


def test_a_refusal_of_the_library_is_no_refusal_of_the_user(monkeypatch, capsys):
    """A ValueError from deep inside says nothing about the arguments."""

    def assemble(_):
        raise ValueError("operands could not be broadcast together")

    monkeypatch.setattr(modes, "assemble", assemble)
    assert cli.main(["modes", PAPER]) == 70
    _, err = capsys.readouterr()
    assert err.startswith("sfd_hbm: an error of the program itself, ValueError: operands ")
    Path(re.search(r"please report it with (.+)\n", err)[1]).unlink()


@pytest.mark.parametrize("number", ["101", "5000", "1000000000"])
def test_no_more_harmonics_than_make_sense(number, capsys):
    with pytest.raises(SystemExit, match="2"):
        cli.main(["solve", PAPER, "--rpm", "3900", "--harmonics", number])
    err = capsys.readouterr().err
    assert err == (
        f"sfd_hbm solve: argument --harmonics: {number} is too many, it must be 100 at most: the "
        "film excites none so high, and the work grows with the third power of their number\n"
    )
