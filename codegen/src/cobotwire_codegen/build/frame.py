"""Builds the frame format and the settings of the transport."""

from __future__ import annotations

from cobotwire_codegen import language
from cobotwire_codegen.build.parts import Parts
from cobotwire_codegen.errors import Place, Problem
from cobotwire_codegen.load import Node
from cobotwire_codegen.model import Address, Frame
from cobotwire_codegen.reader import Reader

_FOOTED = ("command", "data", "footer")
_CHECKED = ("command", "data", "check")


def build_frame_format(parts: Parts, place: Place, problems: list[Problem]) -> Frame:
    """Return the frame format of an edition; a stand-in if the edition lacks it."""
    if parts.frame is None or parts.transport is None:
        return Frame(place, b"\xfe\xfe", "footer", b"\xfa", (), 0, "", 1, 1)
    spec, port = language.Frame, language.Transport
    frame = Reader(parts.frame, spec, "the frame", problems)
    transport = Reader(parts.transport, port, "the transport", problems)
    # These keys inform readers of the file; nothing is generated from them.
    for key in (port.data_bits, port.stop_bits):
        transport.get(key)
    transport.get(port.parity)
    transport.get(port.source)
    frame.get(spec.source)
    word = frame.get(spec.check)
    built = Frame(
        place=frame.place,
        header=frame.get(spec.header) or b"",
        check="sum" if word == "sum" else "footer" if word == "footer" else "crc16-modbus",
        footer=frame.get(spec.footer) or b"",
        addresses=_addresses(frame),
        maximum_data=frame.get(spec.maximum_data),
        doc=frame.get(spec.doc),
        baudrate=transport.get(port.baudrate),
        deadline_ms=transport.get(port.deadline_ms),
    )
    _compare(frame, built)
    return built


def _compare(frame: Reader, built: Frame) -> None:
    """Report keys of the frame that contradict each other."""
    wanted = _FOOTED if built.check == "footer" else _CHECKED
    if frame.get(language.Frame.length_counts) != wanted:
        frame.problem("bad-frame", f"length_counts must be [{', '.join(wanted)}]")
    if len(built.header) != 2 or len(built.footer) != (1 if built.check == "footer" else 0):
        message = "the header must have two bytes; the footer one if `check` is footer, else none"
        frame.problem("bad-frame", message)
    most = 254 - built.check_size
    if built.maximum_data > most:
        message = f"maximum_data of the frame is {built.maximum_data}; allowed: 0..{most}"
        frame.problem("bad-frame", message)


def _addresses(frame: Reader) -> tuple[Address, ...]:
    entries = frame.get(language.Frame.addresses)
    return tuple(_address(name, place, node, frame.problems) for name, place, node in entries)


def _address(name: str, place: Place, node: Node, problems: list[Problem]) -> Address:
    spec = language.Address
    reader = Reader(node, spec, f"the address {name}", problems)
    value, doc = reader.get(spec.value), reader.get(spec.doc)
    return Address(place, name, value, doc, reader.get(spec.replies))
