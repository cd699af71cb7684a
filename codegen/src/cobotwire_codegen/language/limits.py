"""Features of protocols that the language lacks: one registry for error messages and for the page.

Sources: Robotis, e-Manual, "DYNAMIXEL Protocol 2.0" (byte stuffing); RFC 1055 (SLIP); Cheshire and
Baker, "Consistent Overhead Byte Stuffing"; Modbus over serial line V1.02 (silence ends a frame);
Basicmicro, "RoboClaw Series User Manual" (its CRC); Benewake, "TFmini Plus" data sheet; iNav wiki,
"MSP V2"; MAVLink, "Packet Serialization".
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

PAGE = "https://cobotwire.github.io/cobotwire/reference/language.html"


class Limit(NamedTuple):
    """A feature that a spec cannot state: heading, examples, description, and what to do instead.

    ``keys`` are keys that authors try and that the language lacks.
    """

    heading: str
    examples: str
    doc: str
    advice: str
    keys: tuple[str, ...] = ()

    @property
    def message(self) -> str:
        """The message of ``cobotwire-gen check`` for a spec that uses the feature."""
        thing = self.heading[0].lower() + self.heading[1:]
        anchor = self.heading.lower().replace(" ", "-")
        return f"a spec cannot state {thing} ({self.examples}): {self.advice}; see {PAGE}#{anchor}"


STUFFING = Limit(
    "Byte stuffing",
    "Dynamixel 2.0, SLIP, COBS, HDLC",
    "The sender changes data that look like a header or an end: Dynamixel 2.0 sends `FF FF FD FD` "
    "for `FF FF FD`, SLIP `DB DC` for `C0`, and COBS replaces each `00`. The codecs send data as "
    "they are, so such frames would be wrong. If the header suggests stuffing but the device "
    "inserts no bytes, write `stuffing: false` in the frame.",
    "choose a mode of the device without it, such as Dynamixel 1.0",
    ("byte_stuffing", "bit_stuffing", "escape", "escapes", "escaping", "cobs", "slip"),
)
OTHER_ENCODING = Limit(
    "Bytes in another encoding",
    "the ASCII hexadecimal digits of Modbus ASCII, Base64",
    "Each byte of a frame is sent as it is: not as two ASCII digits, and not by COBS or SLIP (see "
    "[byte stuffing](#byte-stuffing)).",
    "choose a binary mode of the device, or use a library for that protocol",
    ("encoding", "ascii", "hexadecimal", "base64"),
)
NO_HEADER = Limit(
    "A protocol without a header",
    "Modbus RTU, RoboClaw",
    "A frame is found by its first bytes. Modbus RTU divides frames by silence, which neither "
    "captures nor TCP preserve.",
    "use a library for that protocol",
    ("header", "gap", "silence"),
)
NO_LENGTH = Limit(
    "A protocol without a length",
    "Modbus RTU, RoboClaw, the data frames of a TFmini",
    "LEN determines where a frame ends, not a delimiter, nor a size that its first bytes imply.",
    "state only the messages that have LEN, such as the commands of a TFmini (header 5A)",
    ("length_counts", "delimiter", "terminator", "frame_size", "fixed_length"),
)
NO_COMMAND = Limit(
    "A protocol without a command id",
    "the data frames of a TFmini",
    "Each request carries an id that identifies the command. Only replies can lack it "
    "(`replies_have_command: false`).",
    "state only the messages that have one",
)
DIRECTION = Limit(
    "A header for each direction",
    "$M<, $M> and $M! of MSP",
    "All frames start with the same bytes. The byte that differs can be an address: for MSP v1 "
    "`header: 24 4D`, and in `addresses` first `HOST: {value: 0x3C, replies: any, doc: ...}`, then "
    "`DEVICE: {value: 0x3E, replies: none, doc: ...}`. An error (`$M!`) is then noise, and the "
    "call ends with a timeout.",
    "state the byte that differs as an address",
    ("direction", "directions", "request_header", "reply_header", "error_header", "headers"),
)
MORE_PARTS = Limit(
    "Further bytes before the data",
    "the sequence number of MAVLink, the flag of MSP v2",
    "Between header and data there are an address of one byte, LEN and CMD, and nothing else. MSP "
    "v1 has no flag.",
    "state bytes after CMD as fields, with `const` if they are constant",
    ("sequence", "sequence_number", "counter", "flags", "flag", "version"),
)
OTHER_CHECK = Limit(
    "A check over bytes of another frame",
    "RoboClaw, where the CRC of a reply also covers address and command of the request",
    "A check covers the bytes of its own frame, from `check_from` to the end of the data.",
    "use a library for that protocol",
)
CHARACTER = Limit(
    "Another character format",
    "Modbus RTU with even parity",
    "Clients open serial ports with 8 data bits, no parity and 1 stop bit.",
    "set the device to 8 data bits, no parity, 1 stop bit",
)
LIMITS = (
    STUFFING,
    OTHER_ENCODING,
    NO_HEADER,
    NO_LENGTH,
    NO_COMMAND,
    DIRECTION,
    MORE_PARTS,
    OTHER_CHECK,
    CHARACTER,
)
# Limits of commands. Their keys are those that authors try in a command.
OTHER_ACK = Limit(
    "An acknowledgement with another id",
    "UBX-ACK-ACK and UBX-ACK-NAK",
    "An acknowledgement carries the id of its request, since only the id shows to which of several "
    "requests it belongs. State a message that acknowledges all requests as a command with "
    "`event: true`; its fields name the request. `ack_within` does not wait for it; a program "
    "waits with `events()` and compares the fields.",
    "state it as an event",
    ("acknowledged_by", "ack_by", "ack_id", "nack", "nack_id", "reply_id", "reply_command"),
)
TWO_ACKS = Limit(
    "Two acknowledgements of one request",
    "a receipt at once, and a result at the end of a motion",
    "A request has one acknowledgement, and `ack_within` returns at the first frame that is a "
    "legal one. If the second one has an id of its own, state it as a command with `event: true`. "
    "If it reports the end of a motion, add `role: motion ended`; then waited motions end with it. "
    "If both have the same id, state only one of them as the acknowledgement; the second "
    "frame is reported as one that nobody waits for.",
    "state the first as the `reply` of the command, which has `ack: true`, the second as an event",
    ("acks", "ack_stages", "second_ack", "final_ack", "completion", "completed_by"),
)
REPLY_AND_PUSH = Limit(
    "One command for a reply and a push",
    "a UBX message that is polled and also sent periodically",
    "A query has a method and a deadline, and an event has neither. State two commands with one "
    "id: the query, and one with `event: true` and `shares_id` with the query. A frame that comes "
    "while a call waits is its reply; at other times it is the event.",
    "state a query, and an event that shares its id",
    ("push", "pushed", "poll", "polled", "periodic", "unsolicited"),
)
COMMAND_LIMITS = (OTHER_ACK, TWO_ACKS, REPLY_AND_PUSH)


def messages_by_key(limits: tuple[Limit, ...]) -> Mapping[str, str]:
    """Return the messages of limits by the keys that authors try."""
    return MappingProxyType({key: limit.message for limit in limits for key in limit.keys})
