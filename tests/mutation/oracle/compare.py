"""Search for a conversation in which a mutant replies differently from the correct device."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from random import Random

from cobotwire import codec as codecs
from cobotwire.codec.interface import Frame
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Table
from cobotwire.simulator.clock import SteppedClock
from mutation.device.stimulus import kind_of
from mutation.mutant import Mutant
from mutation.oracle.conversation import Conversation, Received

ROUNDS = 24
STEPS = 250
# One in this many commands takes part in a conversation.
SHARE = 4


@dataclass(frozen=True, slots=True)
class Difference:
    """Where a mutant's conversation first differs from the correct one."""

    round: int
    right: Received | None
    wrong: Received | None


def conversations(table: Table, command: str, rounds: int = ROUNDS) -> Iterator[Conversation]:
    """Yield the conversations for a mutant of a command; the same ones each time."""
    known = (table.edition, command)
    if known not in _kept:
        # Mutants of one command are judged one after another, so its conversations are cached.
        _kept.clear()
        _kept[known] = []
    kept = _kept[known]
    for seed in range(rounds):
        if seed == len(kept):
            kept.append(_conversation(table, command, seed))
        yield kept[seed]


_kept: dict[tuple[str, str], list[Conversation]] = {}


def _conversation(table: Table, command: str, seed: int) -> Conversation:
    """Return a conversation about some of the commands, drawn at random.

    If all commands took part, one that stops the arm for good would hide all motion.
    """
    random = Random(f"{table.edition} {command} {seed}")
    # Nothing is sent for an event.
    sent = [command for command in table.commands if command.request]
    some = random.sample(sent, len(sent) // SHARE)
    about = []
    if command:
        broken = table.command(command)
        family = [c for c in sent if c.family == broken.family]
        about = [broken] * 4 + random.sample(family, min(4, len(family)))
    conversation = Conversation(table, random, [*some, *about], about)
    conversation.have(STEPS)
    return conversation


def first_difference(table: Table, mutant: Mutant, rounds: int = ROUNDS) -> Difference | None:
    """Return the first difference in ``rounds`` long conversations; None if all are equal."""
    for number, conversation in enumerate(conversations(table, mutant.command, rounds)):
        wrong = replies_of(mutant, conversation)
        if conversation.received != wrong:
            return Difference(number, *_where(conversation.received, wrong))
    return None


def replies_of(mutant: Mutant, conversation: Conversation) -> list[Received]:
    """Return what a mutant sends when a conversation with the correct device is repeated."""
    clock = SteppedClock()
    return conversation.again(mutant.make(clock), clock)


def _where(right: list[Received], wrong: list[Received]) -> tuple[Received | None, Received | None]:
    for ours, theirs in zip(right, wrong):
        if ours != theirs:
            return ours, theirs
    both = min(len(right), len(wrong))
    return (right[both] if both < len(right) else None, wrong[both] if both < len(wrong) else None)


def values_of(table: Table, command: str, field: str, received: list[Received]) -> list[object]:
    """Return every legal value of a reply's field in a conversation."""
    codec = codecs.load(table)
    id = table.command(command).id
    values = []
    framer = codec.framer("reply")
    data = b"".join(piece.data for piece in received)
    for event in (*framer.feed(data), *framer.flush()):
        if isinstance(event, Frame) and event.command == id:
            try:
                replied = codec.decode("reply", event.data, of=command)
            except ProtocolError:
                continue
            values.extend([replied.fields[field]] if field in replied.fields else [])
    return values


def only_legal(table: Table, received: list[Received]) -> bool:
    """Return whether everything received is a frame that the edition allows, or its text."""
    codec = codecs.load(table)
    framer = codec.framer("reply")
    data = b"".join(piece.data for piece in received)
    try:
        for event in (*framer.feed(data), *framer.flush()):
            if isinstance(event, Frame):
                codec.decode("reply", event.data)
            elif kind_of(table, event.data) != "noise":
                return False
    except ProtocolError:
        return False
    return True
