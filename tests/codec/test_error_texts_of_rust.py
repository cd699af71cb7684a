"""Errors have the same texts in Rust as in Python, for every edition, type and frame format."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import probe
import random_tables
from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.protocol.errors import CobotwireError
from cobotwire.protocol.loading import table_of
from cobotwire.protocol.table import Table, Variant
from cobotwire_codegen.publish import edition_json
from random_editions import sensors

pytestmark = probe.needed
Answer = Callable[[dict[str, Any]], str | None]


@pytest.fixture(scope="module")
def answer() -> Iterator[Answer]:
    """Yield a function that asks the probe one question."""
    asked = probe.Probe("texts")
    yield asked.ask
    asked.close()


def text_of(act: Callable[[], object]) -> str | None:
    try:
        act()
    except CobotwireError as error:
        return str(error)
    return None


def as_json(value: Any) -> Any:
    """Return a value as the probe reads it."""
    if value is ...:
        return None
    if isinstance(value, float):
        return {"real": repr(value)}
    if isinstance(value, bytes):
        return {"bytes": value.hex()}
    return [as_json(each) for each in value] if isinstance(value, list) else value


def plain(value: Any) -> Any:
    """Return a value of JSON for one of Python."""
    if isinstance(value, tuple | list):
        return [plain(each) for each in value]
    if isinstance(value, bytearray | memoryview):
        return bytes(value)
    if isinstance(value, int) and abs(value) >= 1 << 63:
        return 1 << 40
    shown = isinstance(value, bool | int | float | str | bytes) or value is ...
    return value if shown else [str(value)]


@st.composite
def near_frames(draw: st.DrawFn, table: Table) -> bytes:
    """Draw a frame, a part of one, or one with more bytes or another byte."""
    frame = draw(random_tables.frames(table))
    at = draw(st.integers(0, len(frame) - 1))
    damaged = (frame[:at], frame + b"\0", frame[:at] + bytes([frame[at] ^ 1]) + frame[at + 1 :])
    return draw(st.sampled_from([frame, *damaged]))


@st.composite
def given_values(draw: st.DrawFn, variants: tuple[Variant, ...]) -> list[Any]:
    """Draw values for a variant, some of them illegal, and at times one too many."""
    drawn = draw(random_tables.values(draw(st.sampled_from(variants)))) if variants else ()
    values: list[Any] = plain(drawn)
    return values if draw(st.integers(0, 9)) else [*values, 0]


def check_one(data: st.DataObject, answer: Answer, table: Table) -> None:
    """Compare the errors of one message and of one frame."""
    command = data.draw(st.sampled_from(table.commands))
    direction = data.draw(st.sampled_from(random_tables.WAYS))
    codec = codecs.load(table, "reference")
    values = data.draw(given_values(command.variants(direction)))
    question = {"command": command.name, "direction": direction, "values": as_json(values)}
    expected = text_of(lambda: codec.encode(command.name, direction, values))
    assert answer(question) == expected
    frame = data.draw(near_frames(table))
    expected = text_of(lambda: codec.decode(direction, frame))
    assert answer({"bytes": frame.hex(), "direction": direction}) == expected


@pytest.mark.parametrize("name", sorted(editions.names()))
@settings(max_examples=20, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_texts_of_an_edition_are_those_of_python(
    answer: Answer, name: str, data: st.DataObject
) -> None:
    path = Path(editions.__file__).parent / name / "edition.json"
    assert answer({"read": str(path)}) is None
    check_one(data, answer, editions.load(name).TABLE)


@settings(max_examples=8, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_texts_of_every_type_in_any_frame_format_are_those_of_python(
    answer: Answer, tmp_path: Path, data: st.DataObject
) -> None:
    path = tmp_path / "edition.json"
    path.write_text(edition_json(data.draw(sensors("sensor"))), encoding="utf-8")
    assert answer({"read": str(path)}) is None
    table = table_of(json.loads(path.read_text(encoding="utf-8")))
    for _ in range(10):
        check_one(data, answer, table)
