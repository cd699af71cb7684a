"""The frame file: the frame format and the transport."""

from __future__ import annotations

from cobotwire_codegen.language import facts
from cobotwire_codegen.language.names import ADDRESS
from cobotwire_codegen.language.records import Named, Part, Record, optional, required
from cobotwire_codegen.language.shapes import Hex, Text, Texts, Whole, Word
from cobotwire_codegen.language.words import CHECKS, REPLIES


class Address(Record):
    """One value of the address byte."""

    value = required(Whole(0, 255, "bad-frame"), "The byte.")
    doc = required(Text(), "Which device has this address.")
    replies = optional(
        Word(REPLIES, REPLIES.values()),
        "From which address the replies to a request come that is sent to this one.",
        "own",
    )
    EXAMPLE = "{value: 0, doc: Every arm., replies: any}"


class Frame(Record):
    """The frame format: header, optional address, LEN, CMD, data, then a footer or a check."""

    header = required(Hex(), "The two bytes that start a frame.")
    length_counts = required(
        Texts(), "What LEN counts: `[command, data, footer]`, or `[command, data, check]`."
    )
    maximum_data = required(
        Whole(0, 253, "bad-frame"), "The largest number of data bytes in a message."
    )
    doc = required(Text(), "What a reader of the reference should know about the frame.")
    footer = optional(Hex(), "The byte that ends a frame. Only if `check` is `footer`.")
    check = optional(Word(CHECKS, CHECKS.values()), "How a damaged frame is detected.", "footer")
    addresses = optional(
        Named(Address, ADDRESS),
        "The values of the address byte before LEN; a client sends the first unless it is given "
        "another. Left out: frames have no address byte.",
    )
    source = facts.source()
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
