"""The comparison with other solvers, as far as it goes without them."""

import ast

import pytest

from benchmarks.peers import __main__ as command
from benchmarks.peers import environments
from benchmarks.peers.duffing import CONTIQUE
from benchmarks.peers.environments import Peer, UnavailableError
from benchmarks.peers.harmonic_balance import PYHARM
from benchmarks.peers.newmark import ROSS
from benchmarks.peers.problem import ROOT, Row


@pytest.mark.parametrize("peer", [CONTIQUE, PYHARM, ROSS])
def test_a_peers_module_answers(peer):
    """It cannot be imported without the peer; run, it must answer the benchmark."""
    source = (ROOT / "benchmarks" / "peers" / f"{peer.module}.py").read_text()
    called = {node.func.id for node in ast.walk(ast.parse(source)) if is_named_call(node)}
    assert "answer" in called


def is_named_call(node):
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name)


def test_a_python_that_is_not_there_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(environments, "CACHE", tmp_path)
    with pytest.raises(UnavailableError, match=r"needs Python 3\.99, which was not found"):
        Peer("nothing", "1.0", "nothing", python=99).run({})


def test_a_peer_that_cannot_run_has_a_row(monkeypatch, capsys):
    def rows():
        raise UnavailableError("needs Python 3.99, which was not found")
        yield

    monkeypatch.setitem(command.CASES, "ross", rows)
    monkeypatch.setattr("sys.argv", ["peers", "ross"])
    command.main()
    assert "| | ross | | | | needs Python 3.99, which was not found |" in capsys.readouterr().out


def test_a_row_shows_the_ratio():
    row = str(Row("work", "peer", 2e-3, 3.1, "1e-9"))
    assert row == "| work | peer | 1,600 | 2 ms | 3.1 s | 1e-9 |"
