"""Diagnose bytes, and name the packets that real lines carry (field notes)."""

from __future__ import annotations

from cobotwire.codec.interface import Codec, Frame, Listening
from cobotwire.diagnose import Diagnoser, Item
from cobotwire.simulator.faults import noise

READ = bytes.fromhex("ff ff 01 04 02 38 02 be")
STATUS = bytes.fromhex("ff ff 01 04 00 ff 07 f4")
SYNC_READ = bytes.fromhex("ff ff fe 0a 82 38 0f 01 02 03 04 05 06 19")
SYNC_WRITE = noise.servo_packet(bytes.fromhex("fe 0c 83 29 07 06 00 10 08 00 00 e8 03"))
PING = bytes.fromhex("ff ff 07 02 01 f5")
FRAME = bytes.fromhex("FE FE 03 12 01 FA")
ANGLES = bytes.fromhex("FE FE 0E 20 00 01 02 03 04 05 06 07 08 09 0A 0B FA")


def diagnose(
    codec: Codec, *chunks: bytes, listening: Listening = "reply", sent: bytes = b""
) -> list[Item]:
    """Return the items of a stream that arrives in these chunks and then falls silent."""
    framer, diagnoser = codec.framer(listening), Diagnoser(codec, listening)
    diagnoser.sent(sent)
    items = [item for chunk in chunks for item in diagnoser.feed(framer.feed(chunk))]
    items += diagnoser.feed(framer.flush()) + diagnoser.flush()
    assert sum(len(item.data) for item in items) == sum(map(len, chunks))
    return items


def only(codec: Codec, data: bytes, listening: Listening = "reply") -> Item:
    (item,) = diagnose(codec, data, listening=listening)
    return item


def kinds(items: list[Item]) -> list[type]:
    """Return the type of each item; frames of either codec are ``Frame``."""
    return [Frame if isinstance(item, Frame) else type(item) for item in items]
