"""Derive a scenario from a recording, so that its faults can be applied to any arm."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from cobotwire.capture import Packet
from cobotwire.codec.interface import Codec, Frame
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Command
from cobotwire.simulator.faults.fault import Fault
from cobotwire.simulator.faults.kinds.additions import Inserted, Where
from cobotwire.simulator.faults.kinds.loss import Lost
from cobotwire.simulator.faults.kinds.timing import Late, Split
from cobotwire.simulator.faults.scenario import Scenario
from cobotwire.simulator.replayed import Exchange, exchanges

# The most that a fault can insert.
MOST_BYTES = 4096
# Shorter pauses occur on healthy lines, too.
SHORTEST_PAUSE = 0.002


class _Where(NamedTuple):
    """A request: the n-th of its id."""

    commands: tuple[str | int, ...]
    nth: tuple[int, ...]


def derived(packets: Iterable[Packet], codec: Codec, name: str = "derived") -> Scenario:
    """Return the faults of a recording: late and lost replies, pauses within them, noise.

    A fault at the n-th recorded request of an id is applied to the n-th request of that id. The
    contents of replies are not kept: a damaged reply counts as noise and as lost. Requests that the
    edition does not have are left out.

    Args:
        packets: those of one line, in any order.
        codec: of the edition by which requests and replies are recognised.
        name: the name of the scenario.

    Raises:
        UsageError: the recording contains no request.
    """
    faults: list[Fault] = []
    counts: Counter[int] = Counter()
    recorded = exchanges(packets)
    if not recorded:
        raise UsageError("packets", message=f"{name}: the recording contains no request")
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
    data = b"".join(chunk for _, chunk in exchange.chunks)
    framer = codec.framer("reply")
    events = [*framer.feed(data), *framer.flush()]
    has_id = codec.table.frame.reply_has_id
    found = [event for event in events if isinstance(event, Frame)]
    replies = [reply for reply in found if reply.command == command.id or not has_id]
    if not replies:
        # A reply of text has no frame: it is lost only if nothing arrived.
        if command.reply and (command.requires_reply or command.ack):
            yield Lost(commands=where.commands, nth=where.nth)
        return
    start, size = replies[0].offset, len(replies[0].data)
    yield from _pauses(exchange, start, size, where)
    yield from _noise(data[:start], "before", where)
    yield from _noise(data[start + size :], "after", where)
    yield Late(commands=where.commands, nth=where.nth, seconds=_time_of(exchange, start))


def _pauses(exchange: Exchange, start: int, size: int, where: _Where) -> Iterator[Fault]:
    at, before = 0, 0.0
    for time, chunk in exchange.chunks:
        if start < at < start + size and time - before >= SHORTEST_PAUSE:
            cut, pause = at - start, time - before
            yield Split(commands=where.commands, nth=where.nth, after_bytes=cut, seconds=pause)
        at, before = at + len(chunk), time


def _noise(data: bytes, side: Where, where: _Where) -> Iterator[Fault]:
    pieces = [data[at : at + MOST_BYTES] for at in range(0, len(data), MOST_BYTES)]
    # Each piece is inserted before, or after, the one that was inserted last.
    for piece in reversed(pieces) if side == "before" else pieces:
        yield Inserted(commands=where.commands, nth=where.nth, data=piece, where=side)


def _time_of(exchange: Exchange, offset: int) -> float:
    """Return when the byte at an offset arrived, in seconds since the request."""
    for time, chunk in exchange.chunks:
        if offset < len(chunk):
            return time
        offset -= len(chunk)
    raise AssertionError("the offset lies within what arrived")
