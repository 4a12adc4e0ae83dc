"""The security policy: of the form that SROS 2 reads, and what the running node needs."""

import time
from collections.abc import Iterator
from xml.etree import ElementTree

import pytest

from .graph import Graph
from .process import PAPER_ROTOR, ROOT

POLICY = ROOT / "sros2" / "predictor.policy.xml"
# As in the schema of SROS 2: the lists, the expressions in them and the rules that they may bear.
LISTS = {"topics": ("topic", {"publish", "subscribe"}), "services": ("service", {"reply"})}
NODE = "predictor"
QUIET = 4.0  # s without a further name; DDS repeats what was lost after up to 3 s


def profile() -> ElementTree.Element:
    root = ElementTree.parse(POLICY).getroot()
    assert (root.tag, root.attrib) == ("policy", {"version": "0.2.0"})
    [profile] = root.findall("./enclaves/enclave/profiles/profile")
    assert profile.attrib == {"ns": "/", "node": NODE}
    return profile


def allowed(rule: str) -> list[str]:
    """Absolute names for which the policy has a rule."""
    names = [entry.text or "" for one in profile() if rule in one.attrib for entry in one]
    return [name.replace("~", f"/{NODE}") for name in names]


@pytest.fixture(scope="module")
def found(graph: Graph, start) -> dict[str, set[str]]:
    """The names that the node uses, by the rule that they need; it waits for a clock, too."""
    given = [f"machine_file:={PAPER_ROTOR}", "use_sim_time:=true"]
    start(*(part for value in given for part in ("-p", value)))
    node = graph.node

    def names() -> Iterator[tuple[str, set[str]]]:
        for rule, look_up in (
            ("publish", node.get_publisher_names_and_types_by_node),
            ("subscribe", node.get_subscriber_names_and_types_by_node),
            ("reply", node.get_service_names_and_types_by_node),
            ("request", node.get_client_names_and_types_by_node),
        ):
            yield rule, {name for name, _ in look_up(NODE, "/")}

    seen: dict[str, set[str]] = {}
    since = time.monotonic()

    def settled() -> dict[str, set[str]]:
        """Return the names once some time has brought no more: they are announced in parts."""
        nonlocal seen, since
        if (now := dict(names())) != seen:
            seen, since = now, time.monotonic()
        return seen if any(seen.values()) and time.monotonic() - since > QUIET else {}

    graph.until(lambda: (NODE, "/") in node.get_node_names_and_namespaces(), "it is found")
    return graph.until(settled, "all its names are found")


def test_policy_has_the_form_that_sros2_reads() -> None:
    for one in profile():
        entry, rules = LISTS[one.tag]
        assert one.attrib.keys() <= rules
        assert set(one.attrib.values()) == {"ALLOW"}
        assert {child.tag for child in one} == {entry}


@pytest.mark.parametrize("rule", ["publish", "subscribe", "reply", "request"])
def test_policy_allows_what_the_node_needs_and_no_more(
    found: dict[str, set[str]], rule: str
) -> None:
    names = allowed(rule)
    assert len(set(names)) == len(names)
    assert found[rule] - set(names) == set(), "the node needs it, the policy does not allow it"
    assert set(names) - found[rule] == set(), "the policy allows it, the node has no use for it"
