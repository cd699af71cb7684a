"""Join the payloads of TCP segments: in the order of their numbers, each byte once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

from cobotwire.capture.foreign.reader import Chunk, ForeignFile
from cobotwire.capture.packet import Direction
from cobotwire.protocol.counted import counted
from cobotwire.protocol.errors import UnreadableInput

# The most segments that wait for a missing one; if more come, it counts as lost.
MOST_WAITING = 64
MOST_CONNECTIONS = 1000
# How many ports without an arm an error names.
LISTED = 8
SYN = 2
_HALF, _MASK = 1 << 31, (1 << 32) - 1


class Segment(NamedTuple):
    """A TCP segment: addresses and ports, numbers, flags and payload."""

    time_ns: int
    source: str
    source_port: int
    target: str
    target_port: int
    number: int
    acknowledged: int
    flags: int
    payload: bytes


class _Connection:
    """The two directions between an arm and a client; ``parts`` counts the streams made of it."""

    def __init__(self, name: str) -> None:
        self.name, self.parts = name, 1
        self.sent = _Flow(self, "sent")
        self.received = _Flow(self, "received")


class _Flow:
    """One direction of a connection.

    Attributes:
        first: the number of its first byte; None before its first segment.
        next: the number of the byte that comes next.
        waiting: the segments after it, by their numbers.
    """

    def __init__(self, connection: _Connection, direction: Direction) -> None:
        self._connection, self._direction = connection, direction
        self.first: int | None = None
        self.next = 0
        self.waiting: dict[int, Segment] = {}
        self._part = 1

    @property
    def stream(self) -> str:
        """The name of the stream that the next bytes belong to."""
        part = f" part {self._part}" if self._part > 1 else ""
        return f"{self._connection.name}{part}"

    def begin(self, number: int, another: bool = False) -> None:
        """Continue at a number: at the start, after lost bytes, or in another connection."""
        if self.first is None or another:
            self.first = number
        self.next = number

    def divide(self) -> None:
        """Begin a new stream, unless the other direction has begun one: then join that one."""
        if self._part == self._connection.parts:
            self._connection.parts += 1
        self._part = self._connection.parts

    def ahead(self, number: int) -> int:
        """Return how far a number is ahead of the next one, in bytes; negative if it is behind."""
        return (number - self.next + _HALF & _MASK) - _HALF

    def keep(self, segment: Segment) -> None:
        """Keep a segment until its bytes come next. Of two with one number, keep the longer."""
        other = self.waiting.get(segment.number)
        if other is None or len(segment.payload) > len(other.payload):
            self.waiting[segment.number] = segment

    def chunk(self, segment: Segment, data: bytes) -> Chunk:
        """Return the next bytes as a chunk."""
        self.next = self.next + len(data) & _MASK
        return Chunk(data, self._direction, segment.time_ns, self.stream)


class Connections:
    """Joins the segments of the arms' ports, and counts those of other ports."""

    def __init__(self, file: ForeignFile) -> None:
        self._file = file
        self._found: dict[tuple[str, int, str, int], _Connection] = {}
        self._repeated = 0
        self._empty = True
        self._other_ports: Counter[int] = Counter()

    def take(self, segment: Segment) -> Iterator[Chunk]:
        """Take the next segment of the capture; yield the bytes that are certain by now."""
        if not (flows := self._flows(segment)):
            return
        flow, opposite = flows
        if segment.flags & SYN:
            yield from self._opened(flow, segment.number + 1 & _MASK)
            return
        # Bytes that the other end acknowledges were not lost on the network, but by the capture.
        while opposite.waiting and opposite.ahead(segment.acknowledged) > _first(opposite):
            yield from self._skip(opposite)
        if not segment.payload:
            return
        self._empty = False
        if flow.first is None:
            flow.begin(segment.number)
        flow.keep(segment)
        yield from self._released(flow)
        if len(flow.waiting) > MOST_WAITING:
            yield from self._skip(flow)

    def end(self) -> Iterator[Chunk]:
        """Take the end of the capture; yield the rest.

        Raises:
            UnreadableInput: no segment belongs to the ports.
        """
        for connection in self._found.values():
            for flow in (connection.sent, connection.received):
                yield from self._rest(flow)
        if self._repeated:
            repeated = counted(self._repeated, "byte")
            self._file.notes.append(f"left out {repeated} that TCP sent more than once")
        if self._empty:
            raise UnreadableInput(self._file.name, self._nothing())

    def _flows(self, segment: Segment) -> tuple[_Flow, _Flow] | None:
        """Return the direction of a segment and the opposite direction; None for other ports."""
        _, source, source_port, target, target_port, *_, payload = segment
        if target_port in self._file.ports:
            key = target, target_port, source, source_port
        elif source_port in self._file.ports:
            key = source, source_port, target, target_port
        else:
            if payload:
                self._other_ports[min(source_port, target_port)] += 1
            return None
        if key not in self._found:
            if len(self._found) == MOST_CONNECTIONS:
                most = f"{MOST_CONNECTIONS} connections to these ports"
                raise UnreadableInput(self._file.name, f"has more than {most}")
            self._found[key] = _Connection("{}:{} from {}:{}".format(*key))
        found = self._found[key]
        flows = found.sent, found.received
        return flows if key[0] == target and key[1] == target_port else flows[::-1]

    def _nothing(self) -> str:
        wanted = " or ".join(map(str, self._file.ports))
        if not self._other_ports:
            return f"holds no TCP payload, neither of port {wanted} nor of another one"
        others = self._other_ports.most_common(LISTED)
        listed = ", ".join(f"{port} ({counted(count, 'packet')})" for port, count in others)
        return (
            f"holds no TCP payload of port {wanted}; it holds ports {listed}: "
            f"choose the arm's, such as --tcp-port {others[0][0]}"
        )

    def _opened(self, flow: _Flow, number: int) -> Iterator[Chunk]:
        """Begin a direction at its SYN; the SYN may be repeated, or begin another connection."""
        if flow.first is None:
            flow.begin(number)
        elif flow.first != number:
            yield from self._rest(flow)
            flow.begin(number, another=True)
            flow.divide()

    def _released(self, flow: _Flow) -> Iterator[Chunk]:
        """Yield the kept bytes that are now next in the stream."""
        while flow.waiting and (ahead := _first(flow)) <= 0:
            segment = flow.waiting.pop(flow.next + ahead & _MASK)
            data = segment.payload[-ahead:]
            self._repeated += len(segment.payload) - len(data)
            if data:
                yield flow.chunk(segment, data)

    def _skip(self, flow: _Flow) -> Iterator[Chunk]:
        """Skip the bytes before the first segment that waits; what follows is another stream."""
        lost = _first(flow)
        flow.begin(flow.next + lost & _MASK)
        before = flow.stream
        flow.divide()
        self._file.missing.append(
            f"lacks {counted(lost, 'byte')} of {before}; what follows them is {flow.stream}"
        )
        yield from self._released(flow)

    def _rest(self, flow: _Flow) -> Iterator[Chunk]:
        while flow.waiting:
            yield from self._skip(flow)


def _first(flow: _Flow) -> int:
    """Return how many bytes are missing before the first segment that waits."""
    return min(map(flow.ahead, flow.waiting))
