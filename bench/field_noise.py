"""Noise as the logs of real arms hold it, piece by piece; each maker draws one piece."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from cobotwire.sim.faults.noise import COMMAND_ERROR, PANIC, REBOOT_NULS, servo_packet
from cobotwire.table import Table

# The heads are those of ``legal_heads``; a table is too large to be asked for them each time.
Maker = Callable[[Sequence[bytes], np.random.Generator], bytes]

INSTRUCTIONS = b"\x01\x02\x03\x04\x05\x82\x83\x00"
ACK = b"\xfe\xfe\x03\x10\x01\xfa"


def servo(heads: Sequence[bytes], random: np.random.Generator) -> bytes:
    """A Feetech packet: any id and instruction, up to twelve parameters, and its checksum."""
    count = int(random.integers(0, 13))
    body = bytes([random.integers(0, 255), count + 2, random.choice(list(INSTRUCTIONS))])
    body += random.bytes(count)
    return servo_packet(body)


def complaint(heads: Sequence[bytes], random: np.random.Generator) -> bytes:
    """What the firmware says of a broken request, again and again."""
    return COMMAND_ERROR * int(random.integers(1, 4))


def panic(heads: Sequence[bytes], random: np.random.Generator) -> bytes:
    """The dump of a panic, about 2.4 kB, and the NULs of the reboot behind it."""
    return PANIC + bytes(REBOOT_NULS)


def text(heads: Sequence[bytes], random: np.random.Generator) -> bytes:
    """A complaint mostly, a panic now and then."""
    return (panic if random.random() < 0.02 else complaint)(heads, random)


def nulls(heads: Sequence[bytes], random: np.random.Generator) -> bytes:
    """A run of NULs."""
    return bytes(int(random.integers(1, 41)))


def header_bytes(heads: Sequence[bytes], random: np.random.Generator) -> bytes:
    """``FE``, up to four times: what a servo's checksum of FE, or a cut frame, leaves behind."""
    return b"\xfe" * int(random.integers(1, 5))


def false_header(heads: Sequence[bytes], random: np.random.Generator) -> bytes:
    """A header that is legal for a reply, with no frame behind it."""
    return heads[int(random.integers(len(heads)))]


def garbage(heads: Sequence[bytes], random: np.random.Generator) -> bytes:
    """Any bytes."""
    return random.bytes(int(random.integers(1, 17)))


def cursed(heads: Sequence[bytes], random: np.random.Generator) -> bytes:
    """Bytes of which many are those that frames are made of: FE, FA, short lengths, known ids."""
    return bytes(random.choice(list(b"\xfe\xfe\xfe\xfa\x03\x04\x0e\x12\x20"), 8).tolist())


def ack(heads: Sequence[bytes], random: np.random.Generator) -> bytes:
    """A late acknowledgement: a legal frame where the edition knows acknowledgements."""
    return ACK


def legal_heads(table: Table) -> list[bytes]:
    """``FE FE LEN CMD`` of every form of every reply."""
    return [
        table.frame.header + bytes([table.frame.length(layout.size), command.id])
        for command in table.commands
        for layout in command.reply
    ]
