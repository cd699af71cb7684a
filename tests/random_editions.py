"""Random protocols in random frame formats: every type of the language, and every frame."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

from hypothesis import strategies as st

import random_specs
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.errors import SpecError
from cobotwire_codegen.model import Edition, Vector
from cobotwire_codegen.wire import build_frame
from random_formats import frame_records
from targets.specs import edition_of

SENSOR = edition_of("sensor")
_BYTES = {"name": "data", "type": "data"}


def in_format(record: dict[str, Any], id: int = 1) -> Edition:
    """Return an edition whose only command sends bytes and receives bytes, in a frame format.

    Raises:
        SpecError: the language does not allow the format.
    """
    data = {"size": [2, 20], "doc": "Some bytes."}
    about = {"title": "Send", "doc": "Sends bytes.", "safety": "query"}
    spec = {
        "edition": "plain",
        "class": "Plain",
        "title": "Bytes",
        "doc": "Bytes.",
        "joints": 0,
        "frame": {"frame": record, "transport": {"baudrate": 9600, "deadline_ms": 500}},
        "types": {"wire": {"byte": {"bytes": 1, "doc": "A byte."}}, "bytes": {"data": data}},
        "commands": {"send": {"id": id, **about, "request": [_BYTES], "reply": [_BYTES]}},
    }
    path = Path("plain.yaml").resolve()
    return build_edition(path, path.parent, {path: json.dumps(spec)})


def formats() -> st.SearchStrategy[tuple[dict[str, Any], Edition]]:
    """Draw a frame format that the language allows, and an edition with it."""

    def allowed(record: dict[str, Any]) -> tuple[dict[str, Any], Edition] | None:
        try:
            return record, in_format(record)
        except SpecError:
            return None

    # A filter draws again; an assumption would end the test.
    found = frame_records().map(allowed)
    return found.filter(lambda made: made is not None)  # type: ignore[return-value]


@st.composite
def editions(draw: st.DrawFn, folder: Path, name: str) -> Edition:
    """Draw an edition; its vectors keep the frames of the format that it had at first."""
    _, edition = draw(random_specs.specs(folder, name))
    check(edition)
    return with_format(edition, draw(formats())[1]) if draw(st.booleans()) else edition


def with_format(edition: Edition, other: Edition) -> Edition:
    """Return the edition with the frame format of another one, large enough for its messages."""
    frame = other.frame
    sizes = [sum(f.type.size for f in v) for c in edition.commands for v in c.replies]
    if min(sizes, default=0) < frame.command_number.width:
        frame = replace(frame, replies_have_command=True)
    return replace(edition, frame=replace(frame, maximum_data=255 - frame.length(0)))


@st.composite
def sensors(draw: st.DrawFn, name: str) -> Edition:
    """Draw a frame format for the sensor, which has every type; its vectors are in such frames."""
    _, other = draw(formats())
    edition = with_format(SENSOR, other)
    made = [replace(vector, frame=_framed(edition, vector)) for vector in edition.vectors]
    return replace(edition, name=name, vectors=tuple(made))


def _framed(edition: Edition, vector: Vector) -> bytes:
    command = next(each for each in edition.commands if each.name == vector.command)
    return build_frame(edition.frame, command, vector.direction, dict(vector.values))
