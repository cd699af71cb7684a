"""Read a statement from YAML; report all mistakes at once, each with its place."""

from __future__ import annotations

from collections.abc import Callable, Collection
from enum import StrEnum
from pathlib import Path
from typing import Any, TypeVar

from cobotwire.conformance.statement.statement import (
    Acknowledgements,
    Statement,
    Support,
    equipment,
    is_mandatory,
)
from cobotwire.protocol.errors import StatementError, UsageError, did_you_mean
from cobotwire.protocol.table import Command, Table
from cobotwire.simulator.faults.nodes import Node, Place, parse

# The version of the format of statements.
FORMAT = 1
WHAT = "statements"
KEYS = (
    *("statement", "edition", "maker", "product", "firmware"),
    *("acknowledgements", "fitted", "commands"),
)
SHOWN = 60
Word = TypeVar("Word", bound=StrEnum)


def load_statement(path: str | Path, table: Table) -> Statement:
    """Read the statement in a file.

    Raises:
        UsageError: the file cannot be read, or the YAML library is not installed.
        StatementError: the file is not a statement about the edition; the text lists all mistakes.
    """
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise UsageError("statement", message=f"{path}: {reason}") from None
    return read_statement(text, table, str(path))


def read_statement(text: str, table: Table, name: str = "statement") -> Statement:
    """Read a statement from text; messages call the file ``name``. See :func:`load_statement`."""
    return _Reader(table).read(parse(text, name, WHAT, StatementError), text)


class _Reader:
    """Reads the keys of a statement, and collects the mistakes."""

    def __init__(self, table: Table) -> None:
        self._table = table
        self._problems: list[tuple[Place, str]] = []

    def read(self, root: Node, text: str) -> Statement:
        """Return the statement; raise a StatementError with all mistakes."""
        entries = self._entries(root, "a statement", KEYS)
        for key in ("statement", "edition"):
            if key not in entries and isinstance(root.value, dict):
                self._report(root.place, f"the key {key} is missing")
        self._must_be(entries.get("statement"), "statement", FORMAT)
        self._must_be(entries.get("edition"), "edition", self._table.edition)
        texts = {
            key: self._text(key, entries[key])
            for key in ("maker", "product", "firmware")
            if key in entries
        }
        acks = entries.get("acknowledgements")
        families = equipment(self._table)
        fitted = self._mapping(entries.get("fitted"), "fitted", families, self._flag)
        names = [command.name for command in self._table.commands]
        commands = self._mapping(entries.get("commands"), "commands", names, self._support)
        found = Statement(
            edition=self._table.edition,
            acknowledgements=Acknowledgements.UNKNOWN
            if acks is None
            else self._word("acknowledgements", acks, Acknowledgements),
            fitted=fitted,
            commands=commands,
            text=text,
            **texts,
        )
        if self._problems:
            lines = [f"{place}: {message}" for place, message in sorted(set(self._problems))]
            raise StatementError(lines)
        return found

    def _report(self, place: Place, message: str) -> None:
        self._problems.append((place, message))

    def _entries(self, node: Node, what: str, known: Collection[str]) -> dict[str, Node]:
        """Return the known keys of a mapping; report the others."""
        if not isinstance(node.value, dict):
            self._report(node.place, f"{what} is {_shown(node)}; allowed: a mapping")
            return {}
        for key in node.value:
            if key not in known:
                hint = did_you_mean(key, known) or f"; known: {', '.join(known)}"
                self._report(node.keys[key], f"{what} has no key {key}{hint}")
        return {key: inner for key, inner in node.value.items() if key in known}

    def _mapping(
        self,
        node: Node | None,
        key: str,
        known: Collection[str],
        value: Callable[[str, Node], Any],
    ) -> dict[str, Any]:
        if node is None or node.value is None:
            return {}
        return {name: value(name, n) for name, n in self._entries(node, key, known).items()}

    def _must_be(self, node: Node | None, key: str, right: object) -> None:
        if node is not None and (node.value != right or isinstance(node.value, bool)):
            hint = did_you_mean(node.value, [str(right)])
            self._report(node.place, f"{key} is {_shown(node)}; allowed: {right}{hint}")

    def _text(self, key: str, node: Node) -> str:
        if isinstance(node.value, str):
            return " ".join(node.value.split())
        if node.value is not None:
            self._report(node.place, f"{key} is {_shown(node)}; allowed: text, in quotes")
        return ""

    def _flag(self, key: str, node: Node) -> bool:
        if not isinstance(node.value, bool):
            self._report(node.place, f"{key} is {_shown(node)}; allowed: true, false")
        return node.value is not False

    def _support(self, name: str, node: Node) -> Support:
        support = self._word(name, node, Support)
        command = self._table.command(name)
        if support is not Support.IMPLEMENTED and is_mandatory(command):
            self._report(node.place, _mandatory(command, support))
        return support

    def _word(self, key: str, node: Node, words: type[Word]) -> Word:
        known = list(words)
        for word in known:
            if node.value == word.value:
                return word
        allowed = ", ".join(known) + did_you_mean(node.value, known)
        self._report(node.place, f"{key} is {_shown(node)}; allowed: {allowed}")
        return known[0]


def _mandatory(command: Command, support: Support) -> str:
    return (
        f"{command.name} is {support}, but every arm must have it (its role: {command.role}); omit "
        "the line: then the run reports that it is missing"
    )


def _shown(node: Node) -> str:
    if isinstance(node.value, dict | list):
        return "a mapping" if isinstance(node.value, dict) else "a list"
    if node.value is None:
        return "nothing"
    text = str(node.value).lower() if isinstance(node.value, bool) else str(node.value)
    return text if len(text) <= SHOWN else f"{text[: SHOWN - 3]}..."
