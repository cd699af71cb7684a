"""Messages that share an id and a size are distinguished by their values, or by a given command."""

from __future__ import annotations

from typing import Any

import pytest

from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Direction
from json_tables import codec_of


@pytest.fixture(params=["reference", "native"])
def alike(request: pytest.FixtureRequest) -> Codec:
    """Return a codec of the sample; each test runs with both codecs."""
    return codec_of("alike", request.param)


def _rejection(codec: Codec, direction: Direction, data: bytes, of: str | None = None) -> Any:
    with pytest.raises(ProtocolError) as caught:
        codec.decode(direction, data, of=of)
    return caught.value.reason, caught.value.offset


def test_commands_with_the_same_id_and_size_are_distinguished_by_values(
    alike: Codec,
) -> None:
    def read(text: str, of: str | None = None) -> tuple[str, str]:
        message = alike.decode("request", bytes.fromhex(f"FEFE{text}FA"), of=of)
        return message.command.name, message.variant.fields[0].name

    assert read("04 60 01 05") == ("set_left", "side")
    assert read("04 60 02 05") == ("set_right", "side")
    assert read("03 61 09") == ("jog", "low")
    assert read("03 61 14") == ("jog", "high")
    assert read("03 61 0A") == ("jog_too", "any")
    assert read("03 61 09", of="jog_too") == ("jog_too", "any")
    with pytest.raises(ProtocolError, match="set_left: side is 3; allowed: 1"):
        read("04 60 03 05")
    with pytest.raises(ProtocolError, match="set_right: side is 1; allowed: 2"):
        read("04 60 01 05", of="set_right")


def test_named_command_restricts_the_variants(alike: Codec) -> None:
    start = bytes.fromhex("FE FE 03 61")
    assert _rejection(alike, "request", start, "jog") == ("truncated", 4)
    assert _rejection(alike, "request", start, "set_left") == ("unknown-id", 3)
    assert _rejection(alike, "request", bytes.fromhex("FE FE 04 61"), "jog") == ("bad-length", 2)
    # A reply with that id and size exists, but it belongs to another command.
    assert _rejection(alike, "reply", start, "jog") == ("bad-length", 2)
    with pytest.raises(UsageError, match="did you mean jog"):
        alike.decode("request", start, of="jogg")


def test_first_variant_that_allows_the_values_is_encoded(alike: Codec) -> None:
    assert alike.encode("jog", "request", (5,))[4] == 5
    assert alike.encode("jog", "request", (25,))[4] == 25
    assert alike.encode("jog", "request", (25,), variant=1)[4] == 25
    with pytest.raises(UsageError, match=r"low is 15; allowed: a whole number 0\.\.9"):
        alike.encode("jog", "request", (15,))
    with pytest.raises(UsageError, match=r"high is 5; allowed: a whole number 20\.\.29"):
        alike.encode("jog", "request", (5,), variant=1)
    with pytest.raises(UsageError, match=r"1 value given for the .*; it takes \(low\) or \(high\)"):
        alike.encode("jog", "request", (5,), variant=2)
