"""Expresses the frame format as calls of construct's classes."""

from __future__ import annotations

from cobotwire_codegen.model import Frame, FrameNumber
from cobotwire_codegen.render.literal import Call, Name


def frame_parts(frame: Frame) -> dict[str, Call]:
    """Return the declarations that all messages share, by name."""
    parts = {
        "HEADER": Call("Const", frame.header),
        "LENGTH": _unsigned(frame.length_number),
        "COMMAND": _unsigned(frame.command_number),
    }
    if frame.address_values:
        first, known = frame.address_values[0], sorted(set(frame.address_values))
        run = len(known) > 2 and known[-1] - known[0] == len(known) - 1
        allowed = Call("between", known[0], known[-1]) if run else tuple(known)
        parts["ADDRESS"] = Call("Default", Call("OneOf", Name("Byte"), allowed), first)
    if frame.check is not None:
        parts["CHECK"] = _check(frame)
    if frame.footer:
        parts["FOOTER"] = Call("Const", frame.footer)
    return parts


def _unsigned(number: FrameNumber) -> Call:
    return Call("BytesInteger", number.width, swapped=number.order == "little")


def _check(frame: Frame) -> Call:
    """Return the check: its function, the first byte that it covers, its width and its order."""
    check = frame.check
    assert check is not None, "the frame has a check"
    if check.crc is not None:
        crc = check.crc
        numbers = (Name(f"0x{number:X}") for number in (crc.poly, crc.init))
        flags = {"refin": crc.refin, "refout": crc.refout, "xorout": Name(f"0x{crc.xorout:X}")}
        function = Call("crc", crc.width, *numbers, **flags)
    elif check.word in ("fletcher", "fletcher-16"):
        function = Call("fletcher", 256 if check.word == "fletcher" else 255)
    elif check.word == "xor":
        function = Call("exclusive_or")
    else:
        # A sum with a factor and a constant: inverted, it is -1 - sum.
        factor, constant = {"sum": (1, 0), "inverted-sum": (-1, -1), "negated-sum": (-1, 0)}[
            check.word
        ]
        function = Call("total", factor, constant, check.width)
    start, little = frame.offset(check.covers_from), check.order == "little"
    return Call("Check", function, start, check.width, little)
