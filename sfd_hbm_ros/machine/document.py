"""A YAML file as plain data, read so that no file can hurt or be misunderstood in silence.

Scalars stay text, as written: what is a number is for the rules to say, so that neither `2.07e11`
(text in YAML 1.1) nor `010` (eight in YAML 1.1) surprises, and errors show values as given.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any, NoReturn

import yaml

from sfd_hbm_ros.machine.errors import MachineError, show_key
from sfd_hbm_ros.machine.safe_file import FilePath, TooLargeError, read_regular, reason

MAX_BYTES = 256 * 1024
"""Room for two thousand shaft segments, and little enough to be read at once."""

MAX_NODES = 25_000
"""Values, keys, lists and mappings: as many as two thousand shaft segments have. The time that
reading takes goes with their number."""

MAX_DEPTH = 12
"""Twice what a machine file needs."""

_NOT_YAML = "is not YAML"


def read_document(path: FilePath) -> Any:
    """Return the data of a YAML file: mappings, lists, text and None for what has no value.

    Raises
    ------
    MachineError
        If the file cannot be read, is no regular file, too large or empty, is not UTF-8 or not
        YAML, holds several documents, a key twice or an alias, too much, or nests too deeply.
    """
    try:
        content = read_regular(path, MAX_BYTES, follow=True)
    except TooLargeError:
        raise MachineError(f"is larger than the {MAX_BYTES // 1024} KiB allowed") from None
    except (OSError, ValueError) as error:
        raise MachineError(f"cannot be read: {reason(error)}") from None
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as error:
        raise MachineError(f"must be UTF-8, which it is not at byte {error.start}") from None
    return parse(text)


def parse(text: str) -> Any:
    """Return the data of a YAML text; raise MachineError as `read_document` does."""
    try:
        data = yaml.load(text, Loader=_StrictLoader)
    except yaml.reader.ReaderError as error:
        line = text.count("\n", 0, error.position) + 1
        raise MachineError(f"line {line}: {error.reason}", discreet=_NOT_YAML) from None
    except yaml.MarkedYAMLError as error:
        raise _error_of(error) from None
    except (ValueError, OverflowError) as error:
        # PyYAML lets pass what chr() raises for escapes beyond Unicode, such as "\U00110000".
        raise MachineError(f"{_NOT_YAML}: {error}", discreet=_NOT_YAML) from None
    if data is None:
        raise MachineError("is empty")
    return data


def _error_of(error: yaml.MarkedYAMLError) -> MachineError:
    """Return where and why a text is not a YAML document, on one line."""
    mark = error.problem_mark or error.context_mark
    place = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
    why = ", ".join(part for part in (error.context, error.problem) if part)
    # PyYAML's own reasons quote the text, while it is not even known whether it is YAML.
    known = error.discreet if isinstance(error, _RefusedError) else _NOT_YAML
    return MachineError(f"{place}{why}".replace("\n", " "), discreet=f"{place}{known}")


class _RefusedError(yaml.MarkedYAMLError):
    """YAML that a machine file must not hold, by PyYAML's kind of error, which knows its line."""

    def __init__(self, problem: str, mark: yaml.Mark, discreet: str = "") -> None:
        super().__init__(problem=problem, problem_mark=mark)
        self.discreet = discreet or problem


class _StrictLoader(yaml.BaseLoader):
    """A loader without types, aliases, repeated keys and deep nesting."""

    depth = 0
    nodes = 0

    def fetch_alias(self) -> NoReturn:
        """Refuse an alias: with it, a small file can be a huge tree."""
        raise _RefusedError("aliases are not allowed: write the values out", self.get_mark())

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        """Refuse nesting so deep that it would exhaust the stack."""
        if parent is not None and self.depth > MAX_DEPTH:
            raise _RefusedError(f"more than {MAX_DEPTH} levels are not allowed", parent.start_mark)
        self.nodes += 1
        if self.nodes > MAX_NODES:
            mark = self.peek_event().start_mark  # type: ignore[no-untyped-call]
            raise _RefusedError(f"more than {MAX_NODES} keys and values are not allowed", mark)
        self.depth += 1
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node

    def construct_scalar(self, node: yaml.ScalarNode) -> Any:
        """Return text, or None for a value left empty or written as null."""
        is_null = node.style is None and node.value in ("", "~", "null")
        return None if is_null else node.value

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Hashable, Any]:
        """Refuse a key that stands twice, of which PyYAML takes the last, or is not text."""
        seen = set()
        for key, _ in node.value:
            if not isinstance(key, yaml.ScalarNode):
                raise _RefusedError("a key must be text", key.start_mark)
            if key.value in seen:
                raise _RefusedError(
                    f"the key {show_key(key.value)} stands twice",
                    key.start_mark,
                    "a key stands twice",
                )
            seen.add(key.value)
        return super().construct_mapping(node, deep)
