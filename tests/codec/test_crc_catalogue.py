"""Every check of the catalogue has its published value, in both codecs and in the generator."""

from __future__ import annotations

import pytest

import small_tables
from cobotwire import codec as codecs
from cobotwire.protocol.table import Check, Crc, FrameFormat, Variant
from cobotwire_codegen.catalogue import CRCS
from cobotwire_codegen.wire import remainder
from strategies import CODECS

DIGITS = b"123456789"
# Fletcher: the sums of RFC 1145 are 0xDD and 0x15; modulo 255 they are 0xDE and 0x1E.
OTHERS = {
    ("sum", 1): 0xDD,
    ("sum", 2): 0x01DD,
    ("inverted-sum", 1): 0x22,
    ("inverted-sum", 2): 0xFE22,
    ("negated-sum", 1): 0x23,
    ("xor", 1): 0x31,
    ("fletcher", 2): 0x15DD,
    ("fletcher-16", 2): 0x1EDE,
}


def checked(check: Check, name: codecs.CodecName) -> bytes:
    """Return the check of the digits, at the end of a frame of one codec."""
    digit = small_tables.field("digits", *[small_tables.number() for _ in DIGITS], many=True)
    command = small_tables.command(1, "send", (Variant((digit,)),))
    frame = FrameFormat(b"\xfe", b"", 40, check)
    codec = codecs.load(small_tables.table(command, frame=frame), name)
    encoded = codec.encode("send", "request", (tuple(DIGITS),))
    assert codec.decode("request", encoded).values == (tuple(DIGITS),)
    return encoded[-check.width :]


@pytest.mark.parametrize("codec", CODECS)
def test_crc_of_the_digits_equals_the_value_in_the_catalogue(codec: codecs.CodecName) -> None:
    for name, (*_, value) in CRCS.items():
        crc = Crc(*CRCS[name][:-1])
        check = Check("crc", "data", -(-crc.width // 8), "big", crc)
        assert checked(check, codec) == value.to_bytes(check.width, "big"), name
    assert len(CRCS) > 100


def test_generator_computes_the_catalogue_too() -> None:
    assert {name: remainder(crc, DIGITS) for name, crc in CRCS.items()} == {
        name: crc.check for name, crc in CRCS.items()
    }


@pytest.mark.parametrize("codec", CODECS)
@pytest.mark.parametrize(("kind", "value"), OTHERS.items())
def test_other_checks_have_their_published_value(
    kind: tuple[str, int], value: int, codec: codecs.CodecName
) -> None:
    algorithm, width = kind
    check = Check(algorithm, "data", width, "little")  # type: ignore[arg-type]
    assert checked(check, codec) == value.to_bytes(width, "little")
