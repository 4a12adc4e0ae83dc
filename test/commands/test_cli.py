"""The command line as such: its verbs and how it refuses."""

from pathlib import Path

import pytest

from sfd_hbm_ros import cli, commands


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
