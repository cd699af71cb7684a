"""Read a statement from YAML; report all mistakes at once, each with its place."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import Any

from cobotwire.conformance.statement.statement import (
    FORMAT,
    Acknowledgements,
    Statement,
    Support,
    equipment,
    is_mandatory,
)
from cobotwire.conformance.workspace import parse_workspace
from cobotwire.protocol.addresses import find_address
from cobotwire.protocol.errors import StatementError, UsageError, did_you_mean
from cobotwire.protocol.table import Command, Table
from cobotwire.simulator.faults.nodes import Node, Place, parse

WHAT = "statements"
SHOWN = 60
# Returns the value of a key as a statement holds it. A ValueError says what is wrong with it.
Rule = Callable[[Any], object]
# The rule of each key; a mapping has rules of its own.
Rules = Mapping[str, "Rule | Rules"]


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
    root = parse(text, name, WHAT, StatementError)
    problems: list[tuple[Place, str]] = []
    values = _mapping(root, "a statement", _rules(table), problems)
    for key in ("statement", "edition"):
        if isinstance(root.value, dict) and key not in root.value:
            problems.append((root.place, f"the key {key} is missing"))
    if problems:
        raise StatementError([f"{place}: {message}" for place, message in sorted(set(problems))])
    del values["statement"]
    ixit = values.pop("ixit", {})
    return Statement(**values, deadlines=ixit.pop("deadlines", {}), ixit=ixit, text=text)


def _rules(table: Table) -> Rules:
    """Return the rules for the keys of a statement; a mapping has a rule for each of its keys."""
    return {
        "statement": partial(_exactly, FORMAT),
        "edition": partial(_exactly, table.edition),
        "maker": _text,
        "product": _text,
        "firmware": _text,
        "acknowledgements": partial(_word, Acknowledgements),
        "ixit": {
            "linger": partial(_between, 0, 60_000, "milliseconds"),
            "workspace": partial(_workspace, table.joints),
            "max_speed": partial(_between, 1, 100, "percent"),
            "baudrate": partial(_between, 1, 100_000_000, "baud"),
            "address": partial(_address, table),
            "deadlines": {
                c.name: partial(_between, 1, c.deadline_ms, "milliseconds")
                for c in table.commands
                if c.requires_reply
            },
        },
        "fitted": dict.fromkeys(equipment(table), _flag),
        "commands": {command.name: partial(_support, command) for command in table.commands},
    }


def _mapping(
    node: Node,
    what: str,
    rules: Rules,
    problems: list[tuple[Place, str]],
) -> dict[str, Any]:
    """Return the values of a mapping; add its mistakes to ``problems``."""
    if not isinstance(node.value, dict):
        if node.value is None:
            message = "the file has no content; a statement is a YAML mapping"
        else:
            message = f"{what} is {_shown(node)}; allowed: a mapping"
        problems.append((node.place, message))
        return {}
    values: dict[str, Any] = {}
    for key, inner in node.value.items():
        rule = rules.get(key)
        if rule is None:
            hint = did_you_mean(key, rules) or f"; known: {', '.join(rules)}"
            problems.append((node.keys[key], f"{what} has no key {key}{hint}"))
        elif isinstance(rule, Mapping):
            values[key] = {} if inner.value is None else _mapping(inner, key, rule, problems)
        else:
            try:
                values[key] = rule(inner.value)
            except ValueError as error:
                problems.append((inner.place, f"{key} is {_shown(inner)}{error}"))
    return values


def _exactly(right: int | str, value: Any) -> int | str:
    if value != right or isinstance(value, bool):
        raise ValueError(f"; allowed: {right}{did_you_mean(value, [str(right)])}")
    return right


def _text(value: Any) -> str:
    if value is not None and not isinstance(value, str):
        raise ValueError("; allowed: text, in quotes")
    return " ".join((value or "").split())


def _flag(value: Any) -> bool:
    if not isinstance(value, bool):
        raise ValueError("; allowed: true, false")
    return value


def _between(least: int, most: int, unit: str, value: Any) -> int:
    if type(value) is not int or not least <= value <= most:
        raise ValueError(f"; allowed: {least}..{most} {unit}")
    return value


def _workspace(joints: int, value: Any) -> str:
    try:
        parse_workspace(_text(value), joints)
    except UsageError as error:
        raise ValueError(f"; allowed: {error.allowed}") from None
    return _text(value)


def _address(table: Table, value: Any) -> str:
    text = str(value) if type(value) is int else _text(value)
    try:
        find_address(table, int(text) if text.isascii() and text.isdigit() else text)
    except UsageError as error:
        raise ValueError(f"; {error}") from None
    return text


def _word(words: type[StrEnum], value: Any) -> StrEnum:
    for word in words:
        if value == word.value:
            return word
    raise ValueError(f"; allowed: {', '.join(words)}{did_you_mean(value, list(words))}")


def _support(command: Command, value: Any) -> StrEnum:
    support = _word(Support, value)
    if support is not Support.IMPLEMENTED and is_mandatory(command):
        raise ValueError(
            f", but every arm must have it (its role: {command.role}); omit the line: then the run "
            "reports that it is missing"
        )
    return support


def _shown(node: Node) -> str:
    if isinstance(node.value, dict | list):
        return "a mapping" if isinstance(node.value, dict) else "a list"
    if node.value is None:
        return "nothing"
    text = str(node.value).lower() if isinstance(node.value, bool) else str(node.value)
    return text if len(text) <= SHOWN else f"{text[: SHOWN - 3]}..."
