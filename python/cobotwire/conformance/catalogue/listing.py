"""List the test cases of all suites, and those of an edition by command."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from hashlib import sha256
from typing import Any, NamedTuple

from cobotwire.conformance.catalogue.history import CLAUSES, HISTORY, NUMBERS
from cobotwire.conformance.client import SUITE as CLIENTS
from cobotwire.conformance.codec import SUITE as CODECS
from cobotwire.conformance.device import SUITE as DEVICES
from cobotwire.conformance.device.permissions import class_of
from cobotwire.conformance.suite import Group, Suite, TestCase
from cobotwire.protocol.table import Command, Table

SUITES: tuple[Suite[Any], ...] = (DEVICES, CLIENTS, CODECS)
# Digests are cut to this many characters.
SHOWN = 12


class Selected(NamedTuple):
    """The test cases of a group for a command; ``None``: they test the transport as a whole."""

    command: Command | None
    group: Group[Any]
    cases: tuple[TestCase, ...]
    permissions: frozenset[str]


def selected(table: Table) -> Iterator[Selected]:
    """Yield what is tested on a device of an edition, in the order of its commands."""
    for command in table.commands:
        for group in DEVICES.groups:
            if command.event or group.declared or group.selects is None:
                continue
            if not group.selects(table, command):
                continue
            cases = tuple(case for case in group.cases if case.applies(command))
            yield Selected(command, group, cases, group.permission | class_of(command))
    for group in DEVICES.groups:
        if group.selects is None or group.declared:
            yield Selected(None, group, group.cases, group.permission)


def digest() -> str:
    """Return the digest of the catalogue: it changes with every word of every test case."""
    listed = [
        [suite.kind, [_listed(group) for group in suite.groups], _cases(suite.cases)]
        for suite in SUITES
    ]
    return _digest(listed)


def _digest(listed: object) -> str:
    return sha256(json.dumps(listed).encode()).hexdigest()[:SHOWN]


def _listed(group: Group[Any]) -> list[object]:
    permission = sorted(group.permission)
    return [group.name, permission, group.sends, group.subject, _cases(group.cases)]


def _cases(cases: Iterable[TestCase]) -> list[list[str]]:
    return [[case.id, case.purpose, case.source] for case in cases]


def misnumbered() -> str:
    """Return what is wrong with the numbers of the clauses; empty if nothing is."""
    for each in HISTORY:
        if _digest(CLAUSES[: each.clauses]) != each.of_clauses:
            return f"the first {each.clauses} clauses are not those of version {each.number}"
    for case in (case.id for suite in SUITES for case in suite.cases):
        if case not in NUMBERS:
            return f"add {case} at the end of CLAUSES in catalogue/history.py"
    return "" if len(NUMBERS) == len(CLAUSES) else "CLAUSES names a test case twice"


def outdated() -> str:
    """Return what must be done because the test cases have changed; empty if they have not."""
    if mistake := misnumbered():
        return mistake
    last, now = HISTORY[-1], digest()
    if last.digest == now:
        return ""
    clauses = f'{len(CLAUSES)}, "{_digest(CLAUSES)}"'
    entry = f'CatalogueVersion({last.number + 1}, "{now}", "what has changed", {clauses})'
    return (
        f"the test cases have changed since version {last.number} of the catalogue; add this entry "
        f"to python/cobotwire/conformance/catalogue/history.py: {entry}"
    )
