"""Random protocols in random frame formats: every type of the language, and every frame."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from hypothesis import strategies as st

import random_specs
from cobotwire_codegen.build.frame_rules import mistakes
from cobotwire_codegen.check import check
from cobotwire_codegen.model import Edition, Vector
from cobotwire_codegen.wire import build_frame
from random_formats import formats
from targets.specs import edition_of

SENSOR = edition_of("sensor")


@st.composite
def editions(draw: st.DrawFn, folder: Path, name: str) -> Edition:
    """Draw an edition. Some get another frame format, which their vectors do not have."""
    _, edition = draw(random_specs.specs(folder, name))
    check(edition)
    other = replace(edition.frame, replies_have_command=False)
    sizes = [sum(f.type.size for f in v) for c in edition.commands for v in c.replies]
    suits = min(sizes, default=0) >= other.command_number.width and not [*mistakes(other)]
    return replace(edition, frame=other) if suits and draw(st.booleans()) else edition


@st.composite
def sensors(draw: st.DrawFn, name: str) -> Edition:
    """Draw a frame format for the sensor, which has every type; its vectors are in such frames."""
    _, other = draw(formats())
    # The sensor has replies without data; without an id, they would be empty.
    edition = replace(SENSOR, frame=replace(other.frame, replies_have_command=True))
    made = [replace(vector, frame=_framed(edition, vector)) for vector in edition.vectors]
    return replace(edition, name=name, vectors=tuple(made))


def _framed(edition: Edition, vector: Vector) -> bytes:
    command = next(each for each in edition.commands if each.name == vector.command)
    return build_frame(edition.frame, command, vector.direction, dict(vector.values))
