"""Have long random conversations with a device, and repeat them with a mutant.

They contain legal and malformed requests.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from random import Random
from typing import NamedTuple

from cobotwire import codec as codecs
from cobotwire.codec.interface import Frame
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Command, Table
from cobotwire.simulator.arm import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.peer import Peer
from mutation.device.broken import Mutant
from mutation.device.cells import checked, framed, kind_of, take_apart
from mutation.device.exchanges import draw_request, shape
from playing import Received, play

# Long enough for a late reply, and for the longest motion of a joint.
PAUSES = (0.0, 0.0, 0.001, 0.02, 0.05, 0.3, 1.0, 8.0)
PART_LEGAL = 0.9
PART_CUT = 0.1
ROUNDS = 24
STEPS = 250
# One in this many commands takes part in a conversation.
SHARE = 4


class Step(NamedTuple):
    """Bytes that are written after a pause in seconds."""

    pause: float
    data: bytes


class Conversation:
    """A conversation with a device that can be repeated with another one.

    It contains requests of some commands, mostly of those in ``about``; some are malformed. It
    begins with a command that switches the power on, because without power an arm carries out few
    commands. Values that the correct device reported may be sent back to it.
    """

    def __init__(
        self,
        table: Table,
        random: Random,
        commands: Sequence[Command],
        about: Sequence[Command] = (),
    ) -> None:
        self.steps: list[Step] = []
        self.received: Received = []
        self._table = table
        self._random = random
        self._commands = commands
        self._about = about
        self._codec = codecs.load(table)
        self._framer = self._codec.framer("reply")
        self._reported: dict[tuple[object, ...], list[int]] = {}
        self._clock = SteppedClock()
        self._right = SimulatedArm(table, clock=self._clock)

    def have(self, steps: int) -> None:
        """Have the conversation with the correct device."""
        openings = [
            c for c in self._table.commands if c.safety == "power" and not c.request[0].fields
        ]
        for command in openings[:1]:
            self._exchange([Step(0.0, draw_request(self._table, command, self._random))])
        while len(self.steps) < steps:
            favoured = self._about and self._random.random() < 0.5
            command = self._random.choice(self._about if favoured else self._commands)
            data = draw_request(self._table, command, self._random, self._reported)
            if self._random.random() > PART_LEGAL:
                data = _damage(self._table, self._random, data)
            self._exchange(_written(self._random, data))
        play(self._right, self._clock, [QUIET], self.received)

    def again(self, peer: Peer, clock: SteppedClock) -> Received:
        """Return what another device sends when it receives the same bytes at the same times."""
        return play(peer, clock, (*self.steps, QUIET))

    def _exchange(self, steps: list[Step]) -> None:
        self.steps.extend(steps)
        before = sum(len(data) for _, data in self.received[-1:])
        pieces = len(self.received)
        play(self._right, self._clock, steps, self.received)
        new = self.received[max(pieces - 1, 0) :]
        self._listen(b"".join(data for _, data in new)[before:])

    def _listen(self, data: bytes) -> None:
        for event in self._framer.feed(data):
            if not isinstance(event, Frame):
                continue
            try:
                message = event.message
            except ProtocolError:
                continue
            cells = take_apart(self._table.frame, message, event.data)
            for field, row in zip(message.variant.fields, cells):
                self._reported[shape(field.cases[0])] = [cell.raw for cell in row]


# The pause at the end of a conversation, in which late replies arrive.
QUIET = Step(max(PAUSES), b"")


def _written(random: Random, data: bytes) -> list[Step]:
    """Return a request in one write, or in several with pauses."""
    pause = random.choice(PAUSES)
    if random.random() > PART_CUT or len(data) < 3:
        return [Step(pause, data)]
    first, second = sorted(random.sample(range(1, len(data)), 2))
    pieces = (data[:first], data[first:second], data[second:])
    return [Step(random.choice(PAUSES[:4]), piece) for piece in pieces]


def _damage(table: Table, random: Random, data: bytes) -> bytes:
    """Return bytes that are not a legal request, or several requests in one write."""
    used = {command.id for command in table.commands}
    unused = [id for id in range(256) if id not in used]
    frame = table.frame
    payload = frame.data(data)
    other = bytes(random.randrange(256) for _ in payload)
    return random.choice(
        (
            data * random.choice((2, 3)),
            data[: random.randrange(1, len(data))],
            data[:-1] + bytes([random.randrange(256)]),
            bytes(random.randrange(256) for _ in range(random.randrange(1, 8))) + data,
            framed(frame, random.choice(unused), payload, frame.address(data)),
            checked(frame, frame.with_length(data, random.randrange(256))),
            framed(frame, frame.read_id(data), other, frame.address(data)),
        )
    )


def conversations(table: Table, command: str, rounds: int = ROUNDS) -> Iterator[Conversation]:
    """Yield the conversations for a mutant of a command; the same ones each time."""
    known = (table.edition, command)
    if known not in _kept:
        # Mutants of one command are run one after another, so its conversations are cached.
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

    If all commands took part, one that stops the arm permanently would hide all motion.
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


def replies_of(table: Table, mutant: Mutant, conversation: Conversation) -> Received:
    """Return what a mutant sends when a conversation with the correct device is repeated."""
    clock = SteppedClock()
    return conversation.again(mutant.make(table, clock), clock)


def only_legal(table: Table, received: Received) -> bool:
    """Return whether everything received is a frame that the edition allows, or its text."""
    codec = codecs.load(table)
    framer = codec.framer("reply")
    data = b"".join(data for _, data in received)
    try:
        for event in (*framer.feed(data), *framer.flush()):
            if isinstance(event, Frame):
                codec.decode("reply", event.data)
            elif kind_of(table, event.data) != "noise":
                return False
    except ProtocolError:
        return False
    return True
