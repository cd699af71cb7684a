"""The editions agree with each frame and size of the maker's pages, or state a dispute about it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

import pytest

import vectors
from cobotwire import codec as codecs
from cobotwire.editions import load
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.frame_index import FrameIndex
from cobotwire.protocol.table import Direction, Table
from cobotwire_codegen.model import Command, Dispute, Quantity

PAGES = vectors.ROOT / "spec" / "public_pages.txt"
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
            except (ProtocolError, UsageError):
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


# Statements of pages beyond frames and sizes: the edition, the command or type, the page, and how
# certain the reading is.
M750 = "the maker's page on the myArm M750"
B1 = "the maker's page on the Mercury B1"
ARDUINO = "the maker's Arduino library"
STATED = (
    *(
        (edition, name, M750, "high")
        for edition in ("myarm_c650", "myarm_m750")
        for name in (
            *("get_angles", "get_robot_error_status", "get_servos_current"),
            "get_servos_protect_current",
        )
    ),
    ("myarm_m750", "limit_angle", M750, "low"),
    ("mercury_b1", "gripper_type", B1, "medium"),
    ("mercury_a1", "motion_status", B1, "medium"),
    ("mercury_b1", "solve_inv_kinematics", B1, "medium"),
    ("mycobot280", "error_code", ARDUINO, "medium"),
    ("pro400", "joint", "the maker's library 4.0.7", "medium"),
    *(
        ("pro450", f"j{joint}_angle", "another version of that page", how)
        for joint, how in zip(range(1, 7), ("high", "medium", *["high"] * 4), strict=True)
    ),
)


def _disputes(edition: str, name: str) -> tuple[Dispute, ...]:
    model = vectors.edition(edition)
    types = [type for type in model.types if isinstance(type, Quantity)]
    found = {type.name: type.disputed for type in types}
    found |= {command.name: command.disputed for command in model.commands}
    return found[name]


@pytest.mark.parametrize(("edition", "name", "source", "confidence"), STATED)
def test_dispute_cites_the_page_that_confirms_or_contradicts_it(
    edition: str, name: str, source: str, confidence: str
) -> None:
    assert any(
        dispute.confidence == confidence
        and source in [evidence.source for evidence in dispute.evidence]
        for dispute in _disputes(edition, name)
    )


def test_gripper_of_the_page_on_the_mercury_b1_is_accepted() -> None:
    codec = codecs.load(load("mercury_b1").TABLE, "reference")
    frame = codec.encode("set_gripper_state", "request", (0, 50, 2))
    assert codec.decode("request", frame).values == (0, 50, 2)


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
