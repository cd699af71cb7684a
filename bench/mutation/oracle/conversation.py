"""Long random conversations, legal and not, made from a table; and what a device says in them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from random import Random
from typing import NamedTuple

from cobotwire import codec as codecs
from cobotwire.codec.interface import Frame
from cobotwire.errors import ProtocolError
from cobotwire.sim.arm import SimulatedArm
from cobotwire.sim.clock import SteppedClock
from cobotwire.sim.memory import TICK_SECONDS
from cobotwire.sim.peer import Peer
from cobotwire.table import Command, Table
from mutation.device.cells import framed, take_apart
from mutation.device.legal import draw_request, shape

# Long enough for a late answer, and for the longest way of a joint.
PAUSES = (0.0, 0.0, 0.001, 0.02, 0.05, 0.3, 1.0, 8.0)
PART_LEGAL = 0.9
PART_CUT = 0.1


class Step(NamedTuple):
    """Bytes that are written, and the seconds that pass before."""

    pause: float
    data: bytes


class Heard(NamedTuple):
    """What a device said at a time."""

    at: float
    data: bytes


class Conversation:
    """A conversation with a device that may be told to be had again with another one.

    Requests of some commands, more often of those that it is ``about``; some are malformed. It
    begins with an order without arguments that is about power, since an arm without it obeys few
    others. What the right device told may be said back to it.
    """

    def __init__(
        self,
        table: Table,
        random: Random,
        commands: Sequence[Command],
        about: Sequence[Command] = (),
    ) -> None:
        self.steps: list[Step] = []
        self.heard: list[Heard] = []
        self._table = table
        self._random = random
        self._commands = commands
        self._about = about
        self._codec = codecs.load(table)
        self._framer = self._codec.framer("reply")
        self._told: dict[tuple[object, ...], list[int]] = {}
        self._clock = SteppedClock()
        self._right = SimulatedArm(table, clock=self._clock)

    def have(self, steps: int) -> None:
        """Talk with the right device."""
        openings = [
            c for c in self._table.commands if c.safety == "power" and not c.request[0].fields
        ]
        for command in openings[:1]:
            self._say([Step(0.0, draw_request(self._table, command, self._random))])
        while len(self.steps) < steps:
            favoured = self._about and self._random.random() < 0.5
            command = self._random.choice(self._about if favoured else self._commands)
            data = draw_request(self._table, command, self._random, self._told)
            if self._random.random() > PART_LEGAL:
                data = _damage(self._table, self._random, data)
            self._say(_written(self._random, data))
        _go_on(self._right, self._clock, [QUIET], self.heard)

    def again(self, peer: Peer, clock: SteppedClock) -> list[Heard]:
        """What another device says when it hears the same at the same times."""
        heard: list[Heard] = []
        _go_on(peer, clock, (*self.steps, QUIET), heard)
        return heard

    def _say(self, steps: list[Step]) -> None:
        self.steps.extend(steps)
        before = sum(len(piece.data) for piece in self.heard[-1:])
        pieces = len(self.heard)
        _go_on(self._right, self._clock, steps, self.heard)
        new = self.heard[max(pieces - 1, 0) :]
        self._listen(b"".join(piece.data for piece in new)[before:])

    def _listen(self, data: bytes) -> None:
        for event in self._framer.feed(data):
            if not isinstance(event, Frame):
                continue
            try:
                message = event.message
            except ProtocolError:
                continue
            cells = take_apart(self._table.frame, message, event.data)
            for field, row in zip(message.layout.fields, cells):
                self._told[shape(field.cases[0])] = [cell.whole for cell in row]


# The end of a conversation: whatever is late has come by then.
QUIET = Step(max(PAUSES), b"")


def _go_on(peer: Peer, clock: SteppedClock, steps: Iterable[Step], heard: list[Heard]) -> None:
    for step in steps:
        _wait(peer, clock, clock() + step.pause, heard)
        if step.data:
            _note(heard, clock(), peer.receive(step.data))


def _wait(peer: Peer, clock: SteppedClock, until: float, heard: list[Heard]) -> None:
    while (wait := peer.wait) is not None and clock() + wait <= until:
        # Where a wait is a rounding error, time goes on all the same.
        clock.sleep(max(wait, TICK_SECONDS))
        _note(heard, clock(), peer.flush())
    clock.sleep(until - clock())


def _note(heard: list[Heard], now: float, data: bytes) -> None:
    """Bytes of one moment are one piece, however they were handed over."""
    if data and heard and heard[-1].at == now:
        heard[-1] = Heard(now, heard[-1].data + data)
    elif data:
        heard.append(Heard(now, data))


def _written(random: Random, data: bytes) -> list[Step]:
    """A request in one write, or in several with pauses."""
    pause = random.choice(PAUSES)
    if random.random() > PART_CUT or len(data) < 3:
        return [Step(pause, data)]
    first, second = sorted(random.sample(range(1, len(data)), 2))
    pieces = (data[:first], data[first:second], data[second:])
    return [Step(random.choice(PAUSES[:4]), piece) for piece in pieces]


def _damage(table: Table, random: Random, data: bytes) -> bytes:
    """Something that is no legal request, or several in one write."""
    used = {command.id for command in table.commands}
    unused = [id for id in range(256) if id not in used]
    return random.choice(
        (
            data * random.choice((2, 3)),
            data[: random.randrange(1, len(data))],
            data[:-1] + bytes([random.randrange(256)]),
            bytes(random.randrange(256) for _ in range(random.randrange(1, 8))) + data,
            framed(table.frame, random.choice(unused), data[4:-1]),
            data[:2] + bytes([random.randrange(256)]) + data[3:],
            data[:4] + bytes(random.randrange(256) for _ in data[4:-1]) + data[-1:],
        )
    )
