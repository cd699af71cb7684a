"""Read scenario files; report all mistakes at once, each with its place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from cobotwire.protocol.errors import ScenarioError, UsageError, did_you_mean
from cobotwire.protocol.table import Table
from cobotwire.simulator.faults.chooser import unknown_command
from cobotwire.simulator.faults.fault import Fault
from cobotwire.simulator.faults.kinds import KINDS
from cobotwire.simulator.faults.nodes import Node, Place, parse
from cobotwire.simulator.faults.rules import RULE, Rule, Several, integer, number
from cobotwire.simulator.faults.scenario import Scenario

SHOWN = 60


def _text(value: Any) -> str:
    if not isinstance(value, str) or not value.strip():
        raise ValueError("text")
    return " ".join(value.split())


SCENARIO_RULES: Mapping[str, Rule] = {
    "about": _text,
    "seed": integer(0, 2**64 - 1),
    "replay": _text,
    "speed": number(1e-3, 1e6),
}


def load(path: str | Path, table: Table | None = None) -> Scenario:
    """Read a scenario file; paths in it are relative to its folder.

    Args:
        path: the file.
        table: the edition that must have the commands; None: their names are not checked.

    Raises:
        UsageError: the file cannot be read, or the YAML library is not installed.
        ScenarioError: the file is not a scenario; the text lists all mistakes.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise UsageError("scenario", message=f"{path}: {reason}") from None
    return _read(parse(text, str(path)), path.stem, table, path.parent)


def loads(text: str, name: str = "scenario", table: Table | None = None) -> Scenario:
    """Read a scenario from text; messages call the file ``name``. See :func:`load`."""
    return _read(parse(text, name), name, table, Path())


def _read(root: Node, name: str, table: Table | None, folder: Path) -> Scenario:
    problems: list[tuple[Place, str]] = []
    entries = _entries(root, "a scenario", problems)
    known = {key: entries.pop(key) for key in [*SCENARIO_RULES, "faults"] if key in entries}
    _report_unknown(entries, root, "a scenario", [*SCENARIO_RULES, "faults"], problems)
    listed = known.pop("faults", None)
    given = _values(known, SCENARIO_RULES, problems)
    if not problems and listed is None and "replay" not in given:
        problems.append((root.place, "a scenario needs faults, or a recording to replay"))
    faults = [] if listed is None else _faults(listed, table, problems)
    if "replay" in given:
        given["replay"] = folder / given["replay"]
        if not given["replay"].is_file():
            problems.append((known["replay"].place, f"there is no file {given['replay']}"))
    if problems:
        raise ScenarioError([f"{place}: {message}" for place, message in sorted(set(problems))])
    return Scenario(name=name, faults=tuple(fault for fault in faults if fault), **given)


def _faults(
    listed: Node, table: Table | None, problems: list[tuple[Place, str]]
) -> list[Fault | None]:
    if not isinstance(listed.value, list):
        problems.append((listed.place, f"faults is {_shown(listed)}; allowed: a list of mappings"))
        return []
    return [_fault(node, table, problems) for node in listed.value]


def _fault(node: Node, table: Table | None, problems: list[tuple[Place, str]]) -> Fault | None:
    entries = _entries(node, "a fault", problems)
    if not isinstance(node.value, dict):
        return None
    named = entries.pop("fault", None)
    if named is None:
        problems.append((node.place, f"the key fault is missing; known: {_known(KINDS)}"))
        return None
    cls = KINDS.get(named.value) if isinstance(named.value, str) else None
    if cls is None:
        hint = did_you_mean(named.value, KINDS) or f"; known: {_known(KINDS)}"
        problems.append((named.place, f"there is no fault {_shown(named)}{hint}"))
        return None
    rules = {field.name: field.metadata[RULE] for field in fields(cls)}
    known = {key: entries.pop(key) for key in rules if key in entries}
    _report_unknown(entries, node, f"the fault {cls.kind}", rules, problems)
    before = len(problems)
    given = _values(known, rules, problems)
    _check_commands(known.get("commands"), table, problems)
    return _made(cls, given, node, problems) if len(problems) == before else None


def _made(
    cls: type[Fault], given: dict[str, Any], node: Node, problems: list[tuple[Place, str]]
) -> Fault | None:
    try:
        return cls(**given)
    except UsageError as error:
        # Each value is allowed, but not their combination.
        key = error.argument.rpartition(".")[2]
        place = node.value[key].place if key in node.value else node.place
        problems.append((place, str(error)))
        return None


def _check_commands(
    node: Node | None, table: Table | None, problems: list[tuple[Place, str]]
) -> None:
    if node is None or table is None:
        return
    for item in node.value if isinstance(node.value, list) else [node]:
        wrong = unknown_command(item.value, table) if isinstance(item.value, str) else None
        if wrong is not None:
            problems.append((item.place, f"commands is {_shown(item)}; allowed: {wrong}"))


def _entries(node: Node, what: str, problems: list[tuple[Place, str]]) -> dict[str, Node]:
    if isinstance(node.value, dict):
        return dict(node.value)
    problems.append((node.place, f"{what} must be a mapping (found: {_shown(node)})"))
    return {}


def _report_unknown(
    left: Mapping[str, Node],
    node: Node,
    what: str,
    known: Any,
    problems: list[tuple[Place, str]],
) -> None:
    for key in left:
        hint = did_you_mean(key, known) or f"; known: {_known(known)}"
        problems.append((node.keys[key], f"{what} has no key {key}{hint}"))


def _values(
    given: Mapping[str, Node], rules: Mapping[str, Rule], problems: list[tuple[Place, str]]
) -> dict[str, Any]:
    kept = {}
    for key, node in given.items():
        try:
            kept[key] = rules[key](_plain(node))
        except ValueError as error:
            place = _misfit(node, rules[key]).place
            problems.append(
                (place, f"{key} is {_shown(_misfit(node, rules[key]))}; allowed: {error}")
            )
    return kept


def _misfit(node: Node, rule: Rule) -> Node:
    """Return the node that does not fit: an item of the list, or all of it."""
    items: list[Node] = node.value if isinstance(node.value, list) else []
    for item in items if isinstance(rule, Several) else []:
        try:
            rule(_plain(item))
        except ValueError:
            return item
    return node


def _plain(node: Node) -> Any:
    if isinstance(node.value, list):
        return [_plain(item) for item in node.value]
    return node.value


def _shown(node: Node) -> str:
    if isinstance(node.value, dict):
        return "a mapping"
    if isinstance(node.value, list):
        return "a list" if node.value else "an empty list"
    if node.value is None:
        return "nothing"
    if isinstance(node.value, int) and abs(node.value) >= 10**SHOWN:
        return f"a number of more than {SHOWN} digits"
    text = str(node.value)
    return text if len(text) <= SHOWN else text[: SHOWN - 3] + "..."


def _known(words: Any) -> str:
    return ", ".join(sorted(words))
