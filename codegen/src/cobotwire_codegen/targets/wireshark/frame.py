"""Turns the frame format into the dissector's table. Offsets count from 0."""

from __future__ import annotations

from typing import Any

from cobotwire_codegen.model import Frame, FrameNumber


def frame_table(frame: Frame) -> dict[str, Any]:
    """Return what the dissector needs to know about frames."""
    sizes = frame.sizes
    data_at = {"request": frame.data_at("request"), "reply": frame.data_at("reply")}
    layout = [part for part in frame.layout if sizes[part]]
    return {
        "header": frame.header,
        # The fixed parts in their order, and where each of them starts.
        "layout": layout,
        "at": {part: frame.offset(part) for part in layout},
        "length": _number(frame.length_number),
        "command": _number(frame.command_number),
        "replies_have_command": frame.replies_have_command,
        # The bytes up to the end of LEN and CMD.
        "head_size": max(frame.offset(p) + sizes[p] for p in ("length", "command")),
        "data_at": data_at,
        # LEN is the number of data bytes plus this.
        "length_of_nothing": {"request": frame.length(0), "reply": frame.length(0, "reply")},
        "maximum_data": frame.maximum_data,
        "address_names": {address.value: address.name for address in frame.addresses},
        "addresses": _spans(frame.address_values),
        "repliers": {a.value: a.replies for a in frame.addresses if a.replies != "own"},
        "check": _check(frame),
        "check_size": frame.check_size,
        "footer": frame.footer,
    }


def _number(number: FrameNumber) -> dict[str, Any]:
    return {"width": number.width, "order": number.order}


def _spans(values: tuple[int, ...]) -> list[list[int]]:
    """Return the first and the last number of each run of consecutive numbers."""
    spans: list[list[int]] = []
    for value in sorted(values):
        if spans and spans[-1][1] == value - 1:
            spans[-1][1] = value
        else:
            spans.append([value, value])
    return spans


def _check(frame: Frame) -> dict[str, Any]:
    """Return the check and where it starts to cover; empty if frames have only a footer."""
    check = frame.check
    if check is None:
        return {}
    made: dict[str, Any] = {
        "word": check.word,
        "from": frame.offset(check.covers_from),
        "width": check.width,
        "order": check.order,
    }
    if check.crc is None:
        return made
    # Digits, since Lua's numbers have 53 bits and some CRCs have 82.
    crc = {key: f"{getattr(check.crc, key):X}" for key in ("poly", "init", "xorout")}
    flags = {"refin": check.crc.refin, "refout": check.crc.refout}
    return made | {"crc": {"width": check.crc.width, **crc, **flags}}
