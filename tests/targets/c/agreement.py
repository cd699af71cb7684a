"""Compare the C code of any protocol with our codec, on messages and streams that tests draw."""

from __future__ import annotations

from hypothesis import strategies as st

from cobotwire.codec.interface import Frame, Listening
from cobotwire.protocol.table import Direction
from cobotwire_codegen.model import Edition
from raw_messages import RawMessage, raw_messages
from strategies import chunked
from targets.c.comparison import joined
from targets.c.compiled import SANITIZERS, program
from targets.c.ours import CodecSide, events
from targets.c.peer import CPeer, Read
from targets.expected import codec_of_edition

LISTENING: st.SearchStrategy[Listening] = st.sampled_from(["request", "reply", "both"])


class Sides:
    """The C code and our codec, for one protocol."""

    def __init__(
        self, edition: Edition, flags: tuple[str, ...] = SANITIZERS, name: str = ""
    ) -> None:
        """Compile the C code; ``name`` names the folder if editions have the same name."""
        self.edition = edition
        self.ours = CodecSide(edition, codec_of_edition(edition))
        self.table = self.ours.codec.table
        self.peer = CPeer(program(edition, "gcc", flags, name))

    def address(self, frame: bytes) -> int:
        """Return the address of a frame, 0 if the format has none."""
        return self.table.frame.address(frame) or 0


def compare_messages(sides: Sides, data: st.DataObject) -> None:
    """Draw a message; compare how it is read and built, and how damaged copies are read."""
    message = data.draw(raw_messages(sides.table))
    _agree(sides, message.direction, message.frame, message)
    frame = bytearray(message.frame)
    start = sides.table.frame.data_start(message.direction)
    for _ in range(data.draw(st.integers(1, 3))):
        frame[data.draw(st.integers(0, len(frame) - 1))] = data.draw(st.integers(0, 255))
    body = bytes(frame[: len(frame) - sides.table.frame.check_size])
    # With a right check, most changes are changes of values; without one, the frame is refuted.
    _agree(sides, message.direction, body + sides.table.frame.end(body))
    _agree(sides, message.direction, bytes(frame[: data.draw(st.integers(start, len(frame)))]))


def _agree(sides: Sides, direction: Direction, frame: bytes, of: RawMessage | None = None) -> None:
    found = sides.peer.read(direction, frame)
    assert sides.ours.read_in_c(found) == sides.ours.read(direction, frame)
    if isinstance(found, Read):
        built = sides.peer.encode(found.message, found.raw_values, sides.address(frame))
        assert of is None or built == frame
        if all(abs(value) < 1e300 for value in found.values):
            address = sides.address(frame)
            assert sides.peer.encode_values(found.message, found.values, address) == built
    if of is not None:
        assert isinstance(found, Read)
        as_one = sides.peer.decode(sides.ours.number(of.variant), frame)
        right = sides.ours.read(direction, frame, of.command.name)
        assert sides.ours.read_in_c(as_one) == right


def compare_streams(sides: Sides, data: st.DataObject) -> None:
    """Draw a stream in chunks; compare the events, and how the frames in them are read."""
    frame = raw_messages(sides.table).map(lambda message: message.frame)
    cut = frame.flatmap(lambda f: st.integers(0, len(f)).map(lambda end: f[:end]))
    header = st.just(sides.table.frame.header)
    stream = b"".join(data.draw(st.lists(frame | cut | header | st.binary(max_size=5), max_size=6)))
    listening = data.draw(LISTENING)
    unknown = data.draw(st.booleans())
    framer = sides.ours.codec.framer(listening, accept_unknown=unknown)
    chunks = data.draw(chunked(stream))
    right = [event for chunk in chunks for event in framer.feed(chunk)] + framer.flush()
    pieces = [*((chunk, False) for chunk in chunks), (b"", True)]
    found, _ = sides.peer.events(listening, pieces, unknown)
    assert joined(found) == joined(list(events(right)))
    for event in right if not unknown else []:
        if isinstance(event, Frame):
            read = sides.peer.read(listening, event.data)
            assert sides.ours.read_in_c(read) == sides.ours.event(event)
