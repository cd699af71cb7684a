"""All raw values of every scaled 16-bit number survive decode and encode, or are rejected."""

from __future__ import annotations

import pytest

import small_tables
from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import FrameFormat, Number, Variant

WORDS = 65_536
# How many raw values share a frame: the reference codec decodes each frame slowly.
EACH = 64


def _kinds() -> list[Number]:
    """Return each different scaled 16-bit number of the shipped editions, without its name."""
    tables = [editions.load(name).TABLE for name in editions.names()]
    found = {
        number._replace(name="", unit="")
        for table in tables
        for command in table.commands
        for variant in (*command.request, *command.reply)
        for field in variant.fields
        for case in field.cases
        for number in case.numbers
        if number.scaled and number.width == 2
    }
    return sorted(found, key=str)


KINDS = _kinds()
# Without limits: all values that the bytes can hold.
WIDE = {
    kind._replace(minimum=kind.raw_range[0], maximum=kind.raw_range[1], choices=())
    for kind in KINDS
}


def _codec(codec: Codec, kind: Number, count: int) -> Codec:
    """Return a codec of a table whose only message has a row of such numbers."""
    field = small_tables.field("row", *[kind] * count, many=True)
    command = small_tables.command(1, "set", (Variant((field,)),))
    table = small_tables.table(command, frame=FrameFormat(b"\xfe\xfe", b"\xfa", 255))
    return codecs.load(table, codec.name)


@pytest.mark.parametrize("kind", sorted(WIDE, key=str), ids=lambda n: f"{n.multiply}/{n.divide}")
def test_every_raw_value_of_every_field_survives_decode_and_encode(
    codec: Codec, kind: Number
) -> None:
    codec = _codec(codec, kind, EACH)
    for start in range(0, WORDS, EACH):
        words = [word.to_bytes(2, kind.order) for word in range(start, start + EACH)]
        frame = codec.table.frame.enclose(1, b"".join(words))
        values = codec.decode("request", frame).values
        # The float nearest to the exact quotient.
        assert values == (tuple(kind.unpack(w) * kind.multiply / kind.divide for w in words),)
        assert codec.encode("set", "request", values) == frame


def test_raw_value_beyond_the_limits_or_the_wire_is_rejected(codec: Codec) -> None:
    for kind in KINDS:
        one = _codec(codec, kind, 1)
        low, high = kind.raw_range
        for raw in (kind.minimum, kind.maximum, kind.minimum - 1, kind.maximum + 1):
            value, allowed = kind.physical(raw), kind.minimum <= raw <= kind.maximum
            frame = one.table.frame.enclose(1, kind.pack(raw))
            if allowed:
                assert one.encode("set", "request", ([value],)) == frame
                assert one.decode("request", frame).values == ((value,),)
                continue
            with pytest.raises(UsageError, match="row") as caught:
                one.encode("set", "request", ([value],))
            assert caught.value.value == value
            assert ".." in caught.value.allowed
            if low <= raw <= high:
                with pytest.raises(ProtocolError, match="row"):
                    one.decode("request", frame)
