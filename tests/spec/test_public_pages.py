"""The editions agree with each frame and size of the maker's pages, or state a dispute about it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

import vectors
from cobotwire import codec as codecs
from cobotwire.editions import load
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.frame_index import FrameIndex
from cobotwire.protocol.table import Direction, Table
from cobotwire_codegen.model import Command

PAGES = Path(__file__).with_name("public_pages.txt")
FRAME = re.compile(r"((?:[0-9A-F]{2} )+)([<>]) (\S+)(?: (.+))?")
SIZES = re.compile(r"([0-9A-F]{2}) (\d+|-) (\d+|-) (\S+)(?: (.+))?")
DIRECTIONS: dict[str, Direction] = {">": "request", "<": "reply"}


class Fact(NamedTuple):
    """One row of the table: a printed frame, or the sizes of a request and its reply."""

    line: int
    edition: str
    source: str
    command: str
    verdict: str
    frame: tuple[Direction, bytes] | None
    sizes: tuple[int, dict[Direction, int]] | None

    def holds(self, table: Table) -> bool:
        """Return whether the edition reads the bytes as this command, or has the sizes."""
        if self.frame is not None:
            of = None if self.command == "-" else self.command
            try:
                codecs.load(table, "reference").decode(*self.frame, of=of)
            except ProtocolError:
                return False
            return True
        assert self.sizes is not None
        id, sizes = self.sizes
        found = [
            {
                message.command.name
                for message in FrameIndex(table, direction).find(
                    id, table.frame.length(size, direction)
                )
            }
            for direction, size in sizes.items()
        ]
        if self.command == "-":
            return all(found)
        return bool(found) and all(self.command in names for names in found)


def _facts() -> Iterator[Fact]:
    edition = source = ""
    for line, row in enumerate(PAGES.read_text(encoding="utf-8").splitlines(), 1):
        if row.startswith("= "):
            edition, source, _ = row[2:].split(" | ")
        elif frame := FRAME.fullmatch(row):
            data, direction, command, verdict = frame.groups()
            shown = DIRECTIONS[direction], bytes.fromhex(data)
            yield Fact(line, edition, source, command, verdict or "", shown, None)
        elif sizes := SIZES.fullmatch(row):
            id, request, reply, command, verdict = sizes.groups()
            stated = {"request": request, "reply": reply}
            known: dict[Direction, int] = {
                direction: int(stated[direction])
                for direction in DIRECTIONS.values()
                if stated[direction] != "-"
            }
            yield Fact(line, edition, source, command, verdict or "", None, (int(id, 16), known))
        else:
            assert not row or row.startswith("#"), f"{PAGES.name}:{line}: {row}"


FACTS = tuple(_facts())


def _command(fact: Fact) -> Command:
    return next(c for c in vectors.edition(fact.edition).commands if c.name == fact.command)


def _cites(fact: Fact) -> bool:
    """Return whether a dispute of the command cites the page."""
    return any(
        evidence.source == fact.source
        for dispute in _command(fact).disputed
        for evidence in dispute.evidence
    )


def test_table_contains_every_fact_that_was_compared() -> None:
    assert len(FACTS) > 430
    assert {fact.verdict.split(":")[0] for fact in FACTS} == {
        *("", "misprint", "disputed", "ruled out")
    }
    assert sum(not fact.verdict for fact in FACTS) > 370


@pytest.mark.parametrize("edition", sorted({fact.edition for fact in FACTS}))
def test_every_fact_of_a_page_has_the_verdict_that_the_table_states(edition: str) -> None:
    table = load(edition).TABLE
    wrong = [
        f"{PAGES.name}:{fact.line}: {fact.command}: {fact.verdict or 'agrees'}"
        for fact in FACTS
        if fact.edition == edition and fact.holds(table) != (not fact.verdict)
    ]
    assert wrong == []


@pytest.mark.parametrize("edition", sorted({fact.edition for fact in FACTS}))
def test_every_disputed_fact_is_cited_by_a_dispute_of_its_command(edition: str) -> None:
    missing = [
        f"{PAGES.name}:{fact.line}: {fact.command} has no dispute that cites {fact.source}"
        for fact in FACTS
        if fact.edition == edition and fact.verdict == "disputed" and not _cites(fact)
    ]
    assert missing == []
