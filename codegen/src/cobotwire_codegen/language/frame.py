"""The frame file: the frame format and the transport."""

from __future__ import annotations

from cobotwire_codegen.catalogue import CATALOGUE, CRCS
from cobotwire_codegen.language import facts
from cobotwire_codegen.language.limits import LIMITS, messages_by_key
from cobotwire_codegen.language.names import ADDRESS
from cobotwire_codegen.language.number_shapes import Range, Whole
from cobotwire_codegen.language.records import Named, Part, Record, optional, required
from cobotwire_codegen.language.shapes import Catalogued, Hex, Text, Texts, Word, YesNo
from cobotwire_codegen.language.words import CHECKS, REPLIES

_ORDER = Word(("big", "little"))


class Address(Record):
    """One value of the address byte."""

    value = required(Whole(0, 255, "bad-frame"), "The byte.")
    doc = required(Text(), "Which device has this address.")
    replies = optional(
        Word(REPLIES, REPLIES.values()),
        "The address from which the replies to a request to this address come.",
        "own",
    )
    joints = optional(
        Whole(1, None, "bad-frame"),
        "How many joints the device has. Left out: as many as the edition. Commands with a value "
        "for each joint cannot be sent to a device with fewer joints.",
        0,
    )
    EXAMPLE = "{value: 0, doc: Every arm., replies: any}"


class Frame(Record):
    """The frame format: header, fixed parts (address, LEN, CMD), data, check and footer."""

    header = required(Hex(), "The one to four bytes that start a frame.")
    length_counts = required(
        Texts(),
        "LEN counts the bytes of these parts. Choose from `header`, `address`, `length`, "
        "`command`, `data`, `check` and `footer`; for instance `[command, data, footer]`.",
    )
    maximum_data = required(
        Whole(0, 4096, "bad-frame"), "The largest number of data bytes in a message."
    )
    doc = required(Text(), "What a reader of the reference should know about the frame.")
    footer = optional(Hex(), "The bytes that end a frame. Left out: it ends with its check.")
    check = optional(
        Catalogued((*CHECKS, *CRCS), CHECKS.values()),
        "How a damaged frame is detected: by a number after the data, or by the footer alone. CRCs "
        f"have the names of [Greg Cook's catalogue]({CATALOGUE}).",
        "footer",
    )
    check_from = optional(
        Word(("header", "address", "length", "command", "data")),
        "The first part that the check covers; it covers all bytes from there to the end of the "
        "data. Left out: `header` for a CRC, `command` for others.",
        "",
    )
    check_bytes = optional(
        Whole(1, 16, "bad-frame"),
        "The size of a sum: 1, 2 or 4. Left out: 1. Each other check has a fixed size.",
        0,
    )
    check_order = optional(
        _ORDER, "Which byte of the check is first: the high one if `big`.", "big"
    )
    layout = optional(
        Texts(),
        "The order of address, LEN and CMD between header and data; the address cannot be last. "
        "Left out: `[address, length, command]`.",
        ("address", "length", "command"),
    )
    length_bytes = optional(Whole(1, 2, "bad-frame"), "The size of LEN. Left out: 1.", 1)
    length_order = optional(_ORDER, "The byte order of LEN.", "big")
    command_bytes = optional(Whole(1, 2, "bad-frame"), "The size of CMD. Left out: 1.", 1)
    command_order = optional(_ORDER, "The byte order of CMD.", "big")
    stuffing = optional(
        YesNo(),
        "Whether bytes are inserted into data that look like a header. Only false can be stated; "
        "it is needed where the header suggests [byte stuffing](#byte-stuffing).",
    )
    replies_have_command = optional(
        YesNo(),
        "Whether replies carry CMD. If not, their data starts where CMD would, each reply is at "
        "least as long as CMD, and a client matches replies by address and size. Left out: true.",
        True,
    )
    addresses = optional(
        Named(Address, ADDRESS),
        "The named values of the address byte; a client sends the first unless it is given "
        "another. Left out: frames have no address byte.",
    )
    address_range = optional(
        Range(), "Further addresses, from the lowest to the highest; each is named by its number."
    )
    source = facts.source()
    LIMITS = messages_by_key(LIMITS)
    EXAMPLE = """\
header: FE FE
footer: FA
length_counts: [command, data, footer]
maximum_data: 16
doc: LEN counts every byte after itself.
"""


class Transport(Record):
    """The serial port, and how long a reply may take."""

    baudrate = required(Whole(1), "Bits per second.")
    deadline_ms = required(
        Whole(1), "How long a client waits for a reply, in milliseconds; a command can override it."
    )
    data_bits = optional(Whole(), "Data bits.")
    stop_bits = optional(Whole(), "Stop bits.")
    parity = optional(Word(("none", "even", "odd")), "The parity bit.", "none")
    source = facts.source()
    EXAMPLE = "{baudrate: 115200, deadline_ms: 500}"


class FrameFile(Record):
    """The frame format and the transport."""

    frame = required(Part(Frame), "The frame format.")
    transport = optional(Part(Transport), "The transport. Only a delta may leave it out.")
