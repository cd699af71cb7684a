"""Builds the frame format and the settings of the transport."""

from __future__ import annotations

from typing import Any

from cobotwire_codegen import language
from cobotwire_codegen.build.frame_rules import beyond_language, mistakes
from cobotwire_codegen.build.parts import Parts
from cobotwire_codegen.catalogue import CRCS, WIDTHS
from cobotwire_codegen.errors import Place, Problem
from cobotwire_codegen.language.limits import CHARACTER
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
    known = len(problems)
    frame = Reader(parts.frame, spec, "the frame", problems)
    transport = Reader(parts.transport, port, "the transport", problems)
    transport.get(port.source)
    frame.get(spec.source)
    check, header = _check(frame), frame.get(spec.header)
    built = Frame(
        place=frame.place,
        header=b"\xfe" if header is None else header,
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
    _check_frame(frame, built, known)
    _compare_port(transport)
    return built


def _check_frame(frame: Reader, built: Frame, known: int) -> None:
    """Report what is wrong with a frame format; ``known`` counts the problems found before."""
    stuffing = frame.get(language.Frame.stuffing) if frame.node(language.Frame.stuffing) else None
    for shown, limit in beyond_language(built, stuffing):
        if not any(limit.message in problem.message for problem in frame.problems[known:]):
            frame.problem("cannot-say", shown + limit.message)
    # These rules compare keys with each other, so they need keys without problems.
    for message in mistakes(built) if len(frame.problems) == known else ():
        frame.problem("bad-frame", message)


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
    """Report a character format other than 8N1, with which the clients open serial ports."""
    port = language.Transport
    usual: tuple[tuple[Key[Any], Any], ...] = (
        (port.data_bits, 8),
        (port.parity, "none"),
        (port.stop_bits, 1),
    )
    given = [(key, transport.get(key), only) for key, only in usual if transport.node(key)]
    if other := [f"{key.name} {value}" for key, value, only in given if value != only]:
        message = f"no client opens a port with {', '.join(other)}; {CHARACTER.message}"
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
