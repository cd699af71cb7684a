"""Random protocols in random frame formats: every type of the language, and every frame."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path

from hypothesis import strategies as st

import random_specs
from cobotwire.protocol.checks import Check
from cobotwire.protocol.frame_format import FrameFormat
from cobotwire_codegen.build.frame_rules import mistakes
from cobotwire_codegen.catalogue import Crc
from cobotwire_codegen.check import check
from cobotwire_codegen.model import Address, Edition, Frame, FrameCheck, FrameNumber, Vector
from cobotwire_codegen.wire import build_frame
from random_formats import frame_formats
from targets.specs import edition_of

SENSOR = edition_of("sensor")


@st.composite
def editions(draw: st.DrawFn, folder: Path, name: str) -> Edition:
    """Draw an edition; its vectors keep the frames of the format that it had at first."""
    _, edition = draw(random_specs.specs(folder, name))
    check(edition)
    return with_format(edition, draw(frame_formats())) if draw(st.booleans()) else edition


def with_format(edition: Edition, format: FrameFormat) -> Edition:
    """Return the edition with another frame format, if all its messages fit into such frames."""
    frame = _frame(edition.frame, format)
    sizes = [sum(f.type.size for f in v) for c in edition.commands for v in c.replies]
    if min(sizes, default=0) < frame.command_number.width:
        frame = replace(frame, replies_have_command=True)
    return replace(edition, frame=replace(frame, maximum_data=255 - frame.length(0)))


@st.composite
def sensors(draw: st.DrawFn, name: str) -> Edition:
    """Draw a frame format for the sensor, which has every type; its vectors are in such frames."""
    found = frame_formats().map(partial(with_format, SENSOR))
    # Half of the formats do not suit. A filter draws again; an assumption would end the test.
    edition = draw(found.filter(lambda edition: not list(mistakes(edition.frame))))
    made = [replace(vector, frame=_framed(edition, vector)) for vector in edition.vectors]
    return replace(edition, name=name, vectors=tuple(made))


def _framed(edition: Edition, vector: Vector) -> bytes:
    command = next(each for each in edition.commands if each.name == vector.command)
    return build_frame(edition.frame, command, vector.direction, dict(vector.values))


def _frame(known: Frame, format: FrameFormat) -> Frame:
    values = format.addresses
    # A range has the addresses beyond the first few, which are named.
    named = values if len(values) < 5 else ()
    return replace(
        known,
        header=format.header,
        check=_check(format.check) if format.check else None,
        footer=format.footer,
        addresses=tuple(Address(known.place, f"A{value}", value, "", "own") for value in named),
        address_range=() if named else values,
        layout=format.layout,
        counted=format.counted,
        length_number=FrameNumber(*format.length_number),
        command_number=FrameNumber(*format.id_number),
        replies_have_command=format.reply_has_id,
    )


def _check(check: Check) -> FrameCheck:
    crc = check.crc and Crc(*check.crc, check=0)
    return FrameCheck(check.algorithm, check.covers_from, check.width, check.order, crc)
