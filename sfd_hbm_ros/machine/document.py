"""A YAML file as plain data, read so that no file can hurt or be misunderstood in silence.

Scalars stay text, as written: what is a number is for the rules to say, so that neither `2.07e11`
(text in YAML 1.1) nor `010` (eight in YAML 1.1) surprises, and errors show values as given.
"""

from __future__ import annotations

import os
from collections.abc import Hashable
from typing import Any, NoReturn

import yaml

from sfd_hbm_ros.machine.errors import MachineError, show_key

MAX_BYTES = 256 * 1024
"""Room for two thousand shaft segments, and little enough to be parsed within seconds."""

MAX_DEPTH = 12
"""Twice what a machine file needs."""

FilePath = str | os.PathLike[str]


def read_document(path: FilePath) -> Any:
    """Return the data of a YAML file: mappings, lists, text and None for what has no value.

    Raises
    ------
    MachineError
        If the file cannot be read, is too large or empty, is not UTF-8 or not YAML, holds several
        documents, a key twice or an alias, or nests too deeply.
    """
    try:
        with open(path, "rb") as file:
            content = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise MachineError(f"cannot be read: {reason}") from None
    if len(content) > MAX_BYTES:
        raise MachineError(f"is larger than the {MAX_BYTES // 1024} KiB allowed")
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
        raise MachineError(f"line {line}: {error.reason}") from None
    except yaml.MarkedYAMLError as error:
        raise MachineError(_sentence(error)) from None
    except (ValueError, OverflowError) as error:
        # PyYAML lets pass what chr() raises for escapes beyond Unicode, such as "\U00110000".
        raise MachineError(f"is not YAML: {error}") from None
    if data is None:
        raise MachineError("is empty")
    return data


def _sentence(error: yaml.MarkedYAMLError) -> str:
    """Return where and why a text is not a YAML document, on one line."""
    mark = error.problem_mark or error.context_mark
    place = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
    reason = ", ".join(part for part in (error.context, error.problem) if part)
    return f"{place}{reason}".replace("\n", " ")


def _error(problem: str, mark: yaml.Mark) -> yaml.MarkedYAMLError:
    """Return PyYAML's own kind of error, which knows its line."""
    return yaml.MarkedYAMLError(problem=problem, problem_mark=mark)


class _StrictLoader(yaml.BaseLoader):
    """A loader without types, aliases, repeated keys and deep nesting."""

    depth = 0

    def fetch_alias(self) -> NoReturn:
        """Refuse an alias: with it, a small file can be a huge tree."""
        raise _error("aliases are not allowed: write the values out", self.get_mark())

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        """Refuse nesting so deep that it would exhaust the stack."""
        if parent is not None and self.depth > MAX_DEPTH:
            raise _error(f"more than {MAX_DEPTH} levels are not allowed", parent.start_mark)
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
                raise _error("a key must be text", key.start_mark)
            if key.value in seen:
                raise _error(f"the key {show_key(key.value)} stands twice", key.start_mark)
            seen.add(key.value)
        return super().construct_mapping(node, deep)
