"""Builds the frame format and the settings of the transport."""

from __future__ import annotations

from cobotwire_codegen import language
from cobotwire_codegen.build.frame_rules import mistakes
from cobotwire_codegen.build.parts import Parts
from cobotwire_codegen.catalogue import CRCS, WIDTHS
from cobotwire_codegen.errors import Place, Problem
from cobotwire_codegen.language.records import Key
from cobotwire_codegen.load import Node
from cobotwire_codegen.model import Address, Frame, FrameCheck, FrameNumber
from cobotwire_codegen.model.frame import Order
from cobotwire_codegen.reader import Reader

_ORDERS: dict[str, Order] = {"big": "big", "little": "little"}


def build_frame_format(parts: Parts, place: Place, problems: list[Problem]) -> Frame:
    """Return the frame format of an edition; a stand-in if the edition lacks it."""
    if parts.frame is None or parts.transport is None:
        return Frame(place, b"\xfe\xfe", None, b"\xfa", (), 0, "", 1, 1)
    spec, port = language.Frame, language.Transport
    frame = Reader(parts.frame, spec, "the frame", problems)
    transport = Reader(parts.transport, port, "the transport", problems)
    _compare_port(transport)
    transport.get(port.source)
    frame.get(spec.source)
    check = _check(frame)
    built = Frame(
        place=frame.place,
        header=frame.get(spec.header) or b"",
        check=check,
        footer=frame.get(spec.footer) or b"",
        addresses=_addresses(frame),
        address_range=_address_range(frame),
        layout=frame.get(spec.layout),
        counted=frame.get(spec.length_counts),
        length_number=_number(frame, spec.length_bytes, spec.length_order),
        command_number=_number(frame, spec.command_bytes, spec.command_order),
        replies_have_command=frame.get(spec.replies_have_command),
        maximum_data=frame.get(spec.maximum_data),
        doc=frame.get(spec.doc),
        baudrate=transport.get(port.baudrate),
        deadline_ms=transport.get(port.deadline_ms),
    )
    for message in mistakes(built):
        frame.problem("bad-frame", message)
    return built


def _check(frame: Reader) -> FrameCheck | None:
    """Return the check that is computed; None if there is only a footer."""
    spec = language.Frame
    word, order = frame.get(spec.check), _ORDERS[frame.get(spec.check_order)]
    crc = CRCS.get(word)
    covers_from = frame.get(spec.check_from) or ("header" if crc else "command")
    width = frame.get(spec.check_bytes)
    if word == "footer":
        return None
    if crc:
        return FrameCheck(word, covers_from, width or -(-crc.width // 8), order, crc)
    return FrameCheck(word, covers_from, width or WIDTHS[word][0], order, None)


def _number(frame: Reader, width: Key[int], order: Key[str]) -> FrameNumber:
    return FrameNumber(frame.get(width), _ORDERS[frame.get(order)])


def _address_range(frame: Reader) -> tuple[int, ...]:
    bounds = frame.get(language.Frame.address_range)
    if bounds is None:
        return ()
    low, high = bounds
    if low.denominator * high.denominator != 1 or not 0 <= low <= high <= 255:
        frame.problem("bad-frame", "address_range must be two bytes: [lowest, highest]")
        return ()
    return tuple(range(int(low), int(high) + 1))


def _compare_port(transport: Reader) -> None:
    """Report another character format than the one with which the clients open serial ports."""
    port = language.Transport
    for key, only in ((port.data_bits, 8), (port.stop_bits, 1)):
        if transport.node(key) is not None and transport.get(key) != only:
            _no_such_port(transport, f"{key.name} {transport.get(key)}")
    if transport.get(port.parity) != "none":
        _no_such_port(transport, f"the parity {transport.get(port.parity)}")


def _no_such_port(transport: Reader, what: str) -> None:
    message = (
        f"no client opens a port with {what}; the format is 8 data bits, no parity, 1 stop bit"
    )
    transport.problem("bad-transport", message)


def _addresses(frame: Reader) -> tuple[Address, ...]:
    entries = frame.get(language.Frame.addresses)
    return tuple(_address(name, place, node, frame.problems) for name, place, node in entries)


def _address(name: str, place: Place, node: Node, problems: list[Problem]) -> Address:
    spec = language.Address
    reader = Reader(node, spec, f"the address {name}", problems)
    value, doc = reader.get(spec.value), reader.get(spec.doc)
    joints = reader.get(spec.joints)
    return Address(place, name, value, doc, reader.get(spec.replies), joints)
