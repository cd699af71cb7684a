"""Describes a frame format for the decoder page: where each part is, and what the check covers."""

from __future__ import annotations

from typing import Any

from cobotwire_codegen.model import Frame, FrameCheck


def frame_record(frame: Frame) -> dict[str, Any]:
    """Return the frame format as plain data; offsets are those of requests."""
    layout = [part for part in frame.layout if frame.sizes[part]]
    numbers = {"length": frame.length_number, "command": frame.command_number}
    parts = {part: {"at": frame.offset(part), "width": frame.sizes[part]} for part in layout}
    return {
        "header": list(frame.header),
        "footer": list(frame.footer),
        "addresses": list(frame.address_values),
        "layout": layout,
        "parts": {
            part: {**place, "order": numbers[part].order if part in numbers else "big"}
            for part, place in parts.items()
        },
        "data_at": {way: frame.data_at(way) for way in ("request", "reply")},
        "replies_have_id": frame.replies_have_command,
        # The bytes that LEN does not count.
        "overhead": frame.data_at("request") + frame.check_size - frame.length(0),
        "head_size": max(frame.offset(part) + frame.sizes[part] for part in numbers),
        "maximum_data": frame.maximum_data,
        "check_size": frame.check_size,
        "check": frame.check and _check(frame, frame.check),
    }


def _check(frame: Frame, check: FrameCheck) -> dict[str, Any]:
    crc = check.crc and {
        "width": check.crc.width,
        "refin": check.crc.refin,
        "refout": check.crc.refout,
        # JavaScript reads large numbers exactly only from texts.
        **{name: hex(getattr(check.crc, name)) for name in ("poly", "init", "xorout")},
    }
    return {
        "word": check.word,
        "from": frame.offset(check.covers_from),
        "width": check.width,
        "order": check.order,
        "crc": crc,
    }
