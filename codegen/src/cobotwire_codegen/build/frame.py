"""The frame and the link."""

from __future__ import annotations

from cobotwire_codegen.build.parts import Parts
from cobotwire_codegen.errors import Problem
from cobotwire_codegen.model import CHECKS, Frame, Member
from cobotwire_codegen.reader import Reader

_FOOTED = ("command", "data", "footer")
_CHECKED = ("command", "data", "check")


def build_frame_format(parts: Parts, outer: Reader, problems: list[Problem]) -> Frame:
    """The frame format of an edition."""
    frame = Reader(parts.frame or outer.root, "the frame", problems)
    link = Reader(parts.link or parts.frame or outer.root, "the link", problems)
    word = frame.one_of("check", CHECKS, "footer")
    wanted = _FOOTED if word == "footer" else _CHECKED
    if frame.texts("length_counts") != wanted:
        frame.problem("bad-frame", f"length_counts must be [{', '.join(wanted)}]")
    frame.lines("source")
    _read_link(link)
    built = Frame(
        place=frame.place,
        header=frame.bytes("header") or b"",
        check="sum" if word == "sum" else "footer" if word == "footer" else "crc16-modbus",
        footer=frame.bytes("footer") or b"",
        addresses=_addresses(frame),
        maximum_data=frame.integer("maximum_data"),
        doc=frame.text("doc"),
        baudrate=link.positive("baudrate"),
        deadline_ms=link.positive("deadline_ms"),
    )
    if len(built.header) != 2 or len(built.footer) != (1 if word == "footer" else 0):
        frame.problem(
            "bad-frame", "the header has two bytes; the footer one, where it is the check"
        )
    if not 0 <= built.maximum_data <= 254 - built.check_size:
        frame.problem("bad-frame", f"LEN is a byte: maximum_data cannot be {built.maximum_data}")
    frame.done()
    link.done()
    return built


def _read_link(link: Reader) -> None:
    for word in ("data_bits", "stop_bits"):
        link.integer(word, 0)
    link.one_of("parity", ("none", "even", "odd"), "none")
    link.lines("source")


def _addresses(frame: Reader) -> tuple[Member, ...]:
    found = []
    for name, place, node in frame.entries("addresses"):
        inner = Reader(node, f"the address {name}", frame.problems)
        member = Member(place, name, inner.integer("value"), inner.text("doc"))
        inner.done()
        if not 0 <= member.value <= 255:
            inner.problem("bad-frame", f"the address {name} = {member.value} is no byte")
        found.append(member)
    return tuple(found)
