"""Is there any conversation in which a mutant says something else than the right device?"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from random import Random

from cobotwire import codec as codecs
from cobotwire.codec.interface import Frame
from cobotwire.errors import ProtocolError
from cobotwire.sim.clock import SteppedClock
from cobotwire.table import Table
from mutation.device.stimulus import kind_of
from mutation.mutant import Mutant
from mutation.oracle.conversation import Conversation, Heard

ROUNDS = 24
STEPS = 250
# One command in so many takes part in a conversation.
SHARE = 4


@dataclass(frozen=True, slots=True)
class Difference:
    """Where a mutant's conversation first differs from the right one."""

    round: int
    right: Heard | None
    wrong: Heard | None


def conversations(table: Table, command: str, rounds: int = ROUNDS) -> Iterator[Conversation]:
    """The conversations that are had for a mutant of a command; the same ones each time."""
    known = (table.edition, command)
    if known not in _had:
        # Mutants of a command follow each other: its conversations are kept until the next one's.
        _had.clear()
        _had[known] = []
    kept = _had[known]
    for seed in range(rounds):
        if seed == len(kept):
            kept.append(_conversation(table, command, seed))
        yield kept[seed]


_had: dict[tuple[str, str], list[Conversation]] = {}


def _conversation(table: Table, command: str, seed: int) -> Conversation:
    """A conversation about some commands only, drawn anew for each.

    An order that stops the arm for good would hide from all conversations what moving shows, if
    every one of them had it.
    """
    random = Random(f"{table.edition} {command} {seed}")  # noqa: S311  (repeatable draws)
    some = random.sample(table.commands, len(table.commands) // SHARE)
    about = []
    if command:
        broken = table.command(command)
        family = [c for c in table.commands if c.family == broken.family]
        about = [broken] * 4 + random.sample(family, min(4, len(family)))
    conversation = Conversation(table, random, [*some, *about], about)
    conversation.have(STEPS)
    return conversation


def first_difference(table: Table, mutant: Mutant, rounds: int = ROUNDS) -> Difference | None:
    """The first difference in ``rounds`` long conversations; None: not one byte, not one time."""
    for number, conversation in enumerate(conversations(table, mutant.command, rounds)):
        wrong = said_by(mutant, conversation)
        if conversation.heard != wrong:
            return Difference(number, *_where(conversation.heard, wrong))
    return None


def said_by(mutant: Mutant, conversation: Conversation) -> list[Heard]:
    """What a mutant says in a conversation that was had with the right device."""
    clock = SteppedClock()
    return conversation.again(mutant.make(clock), clock)


def _where(right: list[Heard], wrong: list[Heard]) -> tuple[Heard | None, Heard | None]:
    for ours, theirs in zip(right, wrong):
        if ours != theirs:
            return ours, theirs
    both = min(len(right), len(wrong))
    return (right[both] if both < len(right) else None, wrong[both] if both < len(wrong) else None)


def values_of(table: Table, command: str, field: str, heard: list[Heard]) -> list[object]:
    """Every value of a reply's field in a conversation; what is not legal is left out."""
    codec = codecs.load(table)
    id = table.command(command).id
    values = []
    framer = codec.framer("reply")
    data = b"".join(piece.data for piece in heard)
    for event in (*framer.feed(data), *framer.flush()):
        if isinstance(event, Frame) and event.command == id:
            try:
                said = codec.decode("reply", event.data, of=command)
            except ProtocolError:
                continue
            values.extend([said.fields[field]] if field in said.fields else [])
    return values


def only_legal(table: Table, heard: list[Heard]) -> bool:
    """Whether all that was heard is frames that the edition allows, or its text."""
    codec = codecs.load(table)
    framer = codec.framer("reply")
    data = b"".join(piece.data for piece in heard)
    try:
        for event in (*framer.feed(data), *framer.flush()):
            if isinstance(event, Frame):
                codec.decode("reply", event.data)
            elif kind_of(table, event.data) != "noise":
                return False
    except ProtocolError:
        return False
    return True
