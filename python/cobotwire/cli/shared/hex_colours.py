"""Colour the bytes of a frame by their part, for terminals."""

from __future__ import annotations

from collections.abc import Callable

import click

from cobotwire.cli.shared.output import as_hex
from cobotwire.protocol.table import FrameFormat

# Takes the bytes of a frame; returns them in hex, with colours.
Paint = Callable[[bytes], str]


def frame_colours(frame: FrameFormat) -> Paint:
    """Return a function that colours a frame: id cyan, payload plain, everything around dim."""
    start, after = frame.id_at, frame.id_at + frame.id_number.width

    def paint(data: bytes) -> str:
        end = len(data) - frame.check_size
        parts = [click.style(as_hex(data[:start]), dim=True)]
        parts.append(click.style(as_hex(data[start:after]), fg="cyan", bold=True))
        if payload := data[after:end]:
            parts.append(as_hex(payload))
        parts.append(click.style(as_hex(data[end:]), dim=True))
        return " ".join(parts)

    return paint
