"""What went wrong in a recording, as a scenario that can be done to any arm."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from cobotwire.capture import Packet
from cobotwire.codec.interface import Codec, Frame
from cobotwire.errors import ProtocolError, UsageError
from cobotwire.sim.faults.fault import Fault
from cobotwire.sim.faults.kinds.additions import Inserted, Where
from cobotwire.sim.faults.kinds.loss import Lost
from cobotwire.sim.faults.kinds.timing import Late, Split
from cobotwire.sim.faults.scenario import Scenario
from cobotwire.sim.replayed import Exchange, exchanges
from cobotwire.table import Command

# As much as a fault can insert.
MOST_BYTES = 4096
# Pieces that come closer together come in one read or in two by chance.
SHORTEST_PAUSE = 0.002


class _Where(NamedTuple):
    """At which request: the n-th of its id."""

    commands: tuple[str | int, ...]
    nth: tuple[int, ...]


def derived(packets: Iterable[Packet], codec: Codec, name: str = "derived") -> Scenario:
    """The faults of a recording: late replies, pauses within them, noise around them, silence.

    The n-th request of an id meets what the n-th of that id met. What a reply said is not kept: a
    damaged one counts as noise and no reply. A request that no edition knows is passed over.

    Args:
        packets: of one line, in any order.
        codec: whose edition tells requests and replies.
        name: what the scenario is called.

    Raises:
        UsageError: nothing was sent.
    """
    faults: list[Fault] = []
    counts: Counter[int] = Counter()
    recorded = exchanges(packets)
    if not recorded:
        raise UsageError("packets", name, "a recording in which something is sent")
    for exchange in recorded:
        command = _command(exchange.request, codec)
        if command is not None:
            counts[command.id] += 1
            where = _Where((command.id,), (counts[command.id],))
            faults += _faults(exchange, command, where, codec)
    return Scenario(
        name=name, about=f"As recorded, in {len(recorded)} requests.", faults=tuple(faults)
    )


def _command(request: bytes, codec: Codec) -> Command | None:
    try:
        return codec.decode("request", request).command
    except ProtocolError:
        return None


def _faults(exchange: Exchange, command: Command, where: _Where, codec: Codec) -> Iterator[Fault]:
    data = b"".join(chunk for _, chunk in exchange.answers)
    framer = codec.framer("reply")
    events = [*framer.feed(data), *framer.flush()]
    replies = [e for e in events if isinstance(e, Frame) and e.command == command.id]
    if not replies:
        # A text has no frame: it is taken for what it is only if something came.
        if command.reply and (command.answers or command.ack):
            yield Lost(commands=where.commands, nth=where.nth)
        return
    start, size = replies[0].offset, len(replies[0].data)
    yield from _pauses(exchange, start, size, where)
    yield from _noise(data[:start], "in front", where)
    yield from _noise(data[start + size :], "behind", where)
    yield Late(commands=where.commands, nth=where.nth, seconds=_time_of(exchange, start))


def _pauses(exchange: Exchange, start: int, size: int, where: _Where) -> Iterator[Fault]:
    at, before = 0, 0.0
    for time, chunk in exchange.answers:
        if start < at < start + size and time - before >= SHORTEST_PAUSE:
            cut, pause = at - start, time - before
            yield Split(commands=where.commands, nth=where.nth, after_bytes=cut, seconds=pause)
        at, before = at + len(chunk), time


def _noise(data: bytes, side: Where, where: _Where) -> Iterator[Fault]:
    pieces = [data[at : at + MOST_BYTES] for at in range(0, len(data), MOST_BYTES)]
    # Each is put in front of the one before, or behind it.
    for piece in reversed(pieces) if side == "in front" else pieces:
        yield Inserted(commands=where.commands, nth=where.nth, data=piece, where=side)


def _time_of(exchange: Exchange, offset: int) -> float:
    """When the byte at an offset came, in seconds since the request."""
    for time, chunk in exchange.answers:
        if offset < len(chunk):
            return time
        offset -= len(chunk)
    raise AssertionError("the offset lies within what was heard")
