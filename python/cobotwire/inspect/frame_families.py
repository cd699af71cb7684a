"""The frame formats of the editions, and how an arm is probed with several of them.

Why that is safe: each probe is a query, which changes nothing. An arm with another frame format may
take a probe for the beginning of a longer frame, and the next probe for the rest of it. So bytes
that end every incomplete frame are sent between two formats (:func:`fill_bytes` returns bytes that
do so for any LEN). A test feeds all probes to the parser of every edition: it finds queries only.
"""

from __future__ import annotations

from cobotwire import editions
from cobotwire.protocol.frame_format import FrameFormat
from cobotwire.protocol.table import Table
from cobotwire.session.alignment import fill_bytes
from cobotwire.transport import Transport
from cobotwire.transport.tapped import tapped


def families(names: list[str]) -> list[list[str]]:
    """Group editions by their frame formats, in the order of the names; the largest group first."""
    found: list[list[str]] = []
    for name in names:
        if not any(name in group for group in found):
            found.append(with_same_frames(names, editions.load(name).TABLE))
    return sorted(found, key=len, reverse=True)


def with_same_frames(names: list[str], table: Table) -> list[str]:
    """Return the editions that have the frame format of a table."""
    return [name for name in names if _same_frames(editions.load(name).TABLE, table)]


def _same_frames(one: Table, other: Table) -> bool:
    first, second = one.frame, other.frame
    return first._replace(maximum_length=second.maximum_length) == second


class Probes:
    """A transport on which frames of several formats are sent.

    Attributes:
        transport: to send probes on.
    """

    def __init__(self, transport: Transport) -> None:
        self._transport = transport
        self._sent = b""
        self.transport = tapped(transport, self._note)

    def separate(self, format: FrameFormat) -> None:
        """End every incomplete frame that a parser of a format may have found so far.

        Raises:
            LinkError: the transport is gone.
        """
        if self._sent:
            self.transport.write(fill_bytes(format, [self._sent]))

    def _note(self, direction: str, data: bytes, at: float) -> None:
        if direction == "sent":
            self._sent += data
