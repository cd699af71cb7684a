"""The C code agrees with our codec on random messages, values, streams and protocols."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, example, given, settings
from hypothesis import strategies as st

import vectors
from cobotwire.codec.interface import Event
from cobotwire_codegen.model import Edition
from cobotwire_codegen.targets.c.messages import messages
from framed_events import joined
from random_editions import editions
from raw_messages import raw_messages
from strategies import TABLES, CommandVariant, chunked, legal_values, variants_of
from targets.c.comparison import Validator
from targets.c.compiled import missing, program
from targets.c.peer import CPeer
from targets.expected import LISTENING, Document
from targets.specs import SPECS, edition_of

pytestmark = pytest.mark.skipif(bool(missing("gcc")), reason=missing("gcc"))
NUMBERS = itertools.count()
QUICK = settings(max_examples=int(os.environ.get("HYPOTHESIS_EXAMPLES", "40")))


class Sides:
    """The C code and our codec, for one protocol."""

    def __init__(self, edition: Edition, name: str = "") -> None:
        """Compile the C code; ``name`` names the folder if editions have the same name."""
        self.messages = messages(edition)
        self.document = Document(edition)
        self.codec = self.document.codec
        self.table = self.codec.table
        self.peer = CPeer(program(edition, name=name), edition)
        self._validator = Validator(edition, self.peer)

    def compare(self) -> None:
        """Compare the vectors of the document, and begin a new one."""
        found = self._validator.compare(self.document.record)
        self.document.clear()
        assert found.differences == []


@pytest.fixture(scope="module", params=[*sorted(TABLES), *sorted(SPECS)])
def sides(request: pytest.FixtureRequest) -> Iterator[Sides]:
    name = request.param
    found = Sides(edition_of(name) if name in SPECS else vectors.edition(name))
    yield found
    found.peer.close()


@QUICK
@given(data=st.data())
def test_messages_and_streams_are_read_and_built_as_in_codec(
    sides: Sides, data: st.DataObject
) -> None:
    sides.document.clear()
    sides.document.draw(data)
    message = data.draw(raw_messages(sides.table))
    frame = bytearray(message.frame)
    for at, byte in data.draw(st.lists(st.tuples(st.integers(0, 40), st.integers(0, 255)))):
        frame[at % len(frame)] = byte
    if len(message.command.variants(message.direction)) == 1:
        sides.document.add(message.direction, bytes(frame), message.variant)
    sides.compare()


@QUICK
@given(data=st.data())
def test_stream_in_any_chunks_with_any_flushes_is_framed_as_in_codec(
    sides: Sides, data: st.DataObject
) -> None:
    frames = raw_messages(sides.table).map(lambda message: message.frame)
    cut = frames.flatmap(lambda f: st.integers(0, len(f)).map(lambda end: f[:end]))
    header = st.just(sides.table.frame.header)
    pieces = st.lists(frames | cut | header | st.binary(max_size=5), max_size=6)
    chunks = data.draw(chunked(b"".join(data.draw(pieces))))
    flushes = [data.draw(st.integers(0, 4)) == 0 for _ in chunks]
    _same_events(sides, data.draw(LISTENING), list(zip(chunks, flushes)), data.draw(st.booleans()))


@pytest.mark.parametrize("longer", [-1, 0, 1])
@pytest.mark.parametrize("sides", sorted(TABLES), indirect=True)
def test_frame_of_unknown_id_is_limited_to_the_longest_length(sides: Sides, longer: int) -> None:
    frame = sides.table.frame
    unknown = min(set(range(256)) - {command.id for command in sides.table.commands})
    length = frame.maximum_length + longer
    data = bytes([length, unknown]) + bytes(length - frame.length(0))
    found = _same_events(sides, "both", [(frame.header + data + frame.footer, True)], True)
    assert getattr(found[0], "reason", "ok") == ("bad-length" if longer > 0 else "ok")


def _same_events(
    sides: Sides, listening: Any, chunks: list[tuple[bytes, bool]], unknown: bool
) -> list[Event]:
    """Check that the C code and our framer give the same events; return them."""
    framer = sides.codec.framer(listening, accept_unknown=unknown)
    right: list[Event] = []
    for chunk, flush in chunks:
        right += framer.feed(chunk) + (framer.flush() if flush else [])
    found, pending = sides.peer.events(listening, chunks, unknown)
    assert joined(found) == joined(right)
    assert pending == framer.pending
    return joined(found)


@st.composite
def _any_values(draw: st.DrawFn, variant: CommandVariant) -> tuple[Any, ...]:
    """Draw legal values, some replaced by a real number (with a scale) or by an integer.

    The numbers are between the steps, on their halves, at and beyond the bounds, and NaN.
    """
    halves = st.integers(-80_000, 80_000).map(lambda steps: steps / 200)

    def other(value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(map(other, value))
        if draw(st.integers(0, 3)):
            return value
        if isinstance(value, float):
            return draw(st.one_of(st.floats(), st.floats(-400, 400), halves))
        return draw(st.integers(-70_000, 70_000))

    fields = variant.variant.fields
    return tuple(
        value if field.choices and len(field.choices) == 1 else other(value)
        for field, value in zip(fields, draw(legal_values(variant.variant)))
    )


@pytest.mark.parametrize("sides", sorted(TABLES), indirect=True)
@QUICK
@given(data=st.data())
@example(data=None)
def test_any_value_is_encoded_or_rejected_as_in_codec(
    sides: Sides, data: st.DataObject | None
) -> None:
    found = [each for each in variants_of(sides.table) if each.variant.fields]
    sides.document.clear()
    if data is None:
        # Only eighths lie exactly between two hundredths: they are rounded to even.
        send_angle = next(each for each in found if each.command.name == "send_angle")
        for eighths in (1, 3, 5, 7, -1, -3, -5, -7):
            sides.document.encode(send_angle, (1, eighths / 8, 20))
    else:
        variant = found[data.draw(st.integers(0, len(found) - 1))]
        sides.document.encode(variant, data.draw(_any_values(variant)))
    sides.compare()


def test_names_in_c_equal_the_names_in_the_spec(sides: Sides) -> None:
    assert sides.peer.names() == [
        [message.command.name, *(member.field.name for member in message.members)]
        for message in sides.messages
    ]


@pytest.mark.parametrize("sides", sorted(TABLES), indirect=True)
def test_too_small_buffer_is_rejected_and_not_overrun(sides: Sides) -> None:
    for number, message in enumerate(sides.messages):
        size = message.size + 5
        short = sides.peer.encode(number, [0] * message.count, room=size - 1)
        assert not isinstance(short, bytes)
        assert short.status == "no-room"
        enough = sides.peer.encode(number, [0] * message.count, room=size)
        assert isinstance(enough, bytes) or enough.status == "bad-value"


@pytest.mark.parametrize("sides", ["sensor"], indirect=True)
def test_odd_texts_and_too_many_elements_are_rejected(sides: Sides) -> None:
    sides.document.clear()
    sides.document.add_odd_texts()
    sides.compare()
    symbols = [message.symbol for message in sides.messages]
    number = symbols.index("set_temperatures_request")
    assert sides.peer.encode(number, [41, *[20] * 41]) == ("bad-value", number, 0, 0, 0)
    enough = sides.peer.encode(number, [40, *[20] * 40])
    assert isinstance(enough, bytes)
    assert len(enough) == 45


# Each example compiles a program, so shrinking would take minutes.
@settings(
    max_examples=3, phases=[Phase.reuse, Phase.generate], suppress_health_check=list(HealthCheck)
)
@given(data=st.data())
def test_random_protocol_runs_in_c(tmp_path: Path, data: st.DataObject) -> None:
    sides = Sides(data.draw(editions(tmp_path, f"rnd{next(NUMBERS)}")))
    for _ in range(6):
        sides.document.draw(data)
    sides.compare()
    sides.peer.close()
