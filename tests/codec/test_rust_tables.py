"""Rust reads the same table as Python from an ``edition.json``, and makes the same error texts.

The codec in Rust is tested as the native codec: it interprets the same tables.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any
from unicodedata import category

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import random_tables
from cobotwire import codec as codecs
from cobotwire._native import NativeCodec
from cobotwire.protocol.errors import CobotwireError
from cobotwire.protocol.loading import table_of
from cobotwire.protocol.table import Table, Variant
from cobotwire_codegen.publish import edition_json
from probe import Probe, needed
from random_editions import editions, sensors
from session.twins import plain
from strategies import DIRECTIONS
from vectors import ROOT

pytestmark = needed
EDITIONS = sorted((ROOT / "python/cobotwire/editions").glob("*/edition.json"))
MYCOBOT = ROOT / "python/cobotwire/editions/mycobot/edition.json"
# Besides the smallest edition: editions with addresses, floats and lists.
DAMAGED = ["mycobot", "mybuddy", "pro450"]
OTHERS: list[Any] = [
    *(None, True, -1, 0, 1, 2, 8, 255, 1 << 14, -(1 << 63), (1 << 63) - 1, (1 << 64) - 1, 1e300),
    *(0.5, "1/0", "9223372036854775807/3", "", "text", "bits", "joint", "float"),
    *([], [[]], [0, 1], {}),
]
# Each of 3,000 numbers repeats 100,000 choices: 2.4 GB.
WIDE = {"name": "wide", "kind": "quantity", "wire": "byte", "choices": [1] * 100_000}
ROW = {"name": "row", "kind": "value", "items": [{"name": "x", "type": "wide"}] * 3000}
RANDOM = [HealthCheck.function_scoped_fixture, HealthCheck.too_slow]


def text_of(act: Callable[..., object], *arguments: object) -> str | None:
    try:
        act(*arguments)
    except CobotwireError as error:
        return str(error)
    return None


def given_value(value: Any) -> Any:
    """Return a value that Python and the Rust clients can both represent."""
    if isinstance(value, tuple | list):
        return tuple(map(given_value, value))
    if isinstance(value, bytearray | memoryview):
        return bytes(value)
    if isinstance(value, str):
        # Rust may know a later version of Unicode, which has more printable characters.
        return "".join(char for char in value if category(char) != "Cn")
    # The clients take a whole number for an integer, whatever its type.
    if isinstance(value, float) and value.is_integer() and abs(value) < 1 << 53:
        value = int(value)
    if isinstance(value, int) and abs(value) >= 1 << 63:
        return 1 << 40
    known = isinstance(value, bool | int | float | bytes) or value is ...
    return value if known else (str(value),)


@st.composite
def near_frames(draw: st.DrawFn, table: Table) -> bytes:
    """Draw a frame, a part of one, or one with more bytes or another byte."""
    frame = draw(random_tables.frames(table))
    at = draw(st.integers(0, len(frame) - 1))
    damaged = (frame[:at], frame + b"\0", frame[:at] + bytes([frame[at] ^ 1]) + frame[at + 1 :])
    return draw(st.sampled_from([frame, *damaged]))


@st.composite
def given_values(draw: st.DrawFn, variants: tuple[Variant, ...]) -> tuple[Any, ...]:
    """Draw values for a variant, some of them illegal, and at times one too many."""
    drawn = draw(random_tables.values(draw(st.sampled_from(variants)))) if variants else ()
    values: tuple[Any, ...] = given_value(drawn)
    return values if draw(st.integers(0, 9)) else (*values, 0)


def check_texts(data: st.DataObject, probe: Probe, path: Path, table: Table, times: int) -> None:
    """Compare the errors of messages and of frames."""
    codec, steps, expected = codecs.load(table, "reference"), list[Any](), list[str | None]()
    for _ in range(times):
        command = data.draw(st.sampled_from(table.commands))
        direction = data.draw(st.sampled_from(DIRECTIONS))
        values = data.draw(given_values(command.variants(direction)))
        frame = data.draw(near_frames(table))
        steps.append(["encode", str(path), direction, command.name, plain(values)])
        expected.append(text_of(codec.encode, command.name, direction, values))
        steps.append(["decode", str(path), direction, frame.hex()])
        expected.append(text_of(codec.decode, direction, frame))
    assert [*zip(steps, probe.ask(steps))] == [*zip(steps, expected)]


def native_table(table: Table) -> str:
    """Return the table that the native codec interprets, as Rust prints it."""
    codec: Any = NativeCodec(table)
    text: str = codec._core_table()
    return text


@pytest.mark.parametrize("path", EDITIONS, ids=lambda path: path.parent.name)
@settings(max_examples=1, suppress_health_check=RANDOM)
@given(data=st.data())
def test_edition_has_same_table_and_texts(probe: Probe, path: Path, data: st.DataObject) -> None:
    table = table_of(json.loads(path.read_text("utf-8")))
    assert probe.ask([["table", str(path)]]) == [native_table(table)]
    check_texts(data, probe, path, table, 20)


# Shrinking would take minutes.
@settings(max_examples=16, phases=[Phase.generate], suppress_health_check=RANDOM)
@given(data=st.data(), every_type=st.booleans())
def test_random_edition_has_same_table_and_texts(
    probe: Probe,
    tmp_path_factory: pytest.TempPathFactory,
    data: st.DataObject,
    every_type: bool,
) -> None:
    folder = tmp_path_factory.mktemp("random")
    edition = data.draw(sensors("sensor") if every_type else editions(folder, "rnd"))
    path = folder / "edition.json"
    path.write_text(edition_json(edition), encoding="utf-8")
    table = table_of(json.loads(path.read_text("utf-8")))
    assert probe.ask([["table", str(path)]]) == [native_table(table)]
    check_texts(data, probe, path, table, 10)


def changed(document: Any, dice: Random) -> Any:
    """Return a copy of a document with one random value replaced."""
    keys = [*range(len(document))] if isinstance(document, list) else []
    keys = [*document] if isinstance(document, dict) else keys
    if not keys or dice.random() < 0.1:
        return dice.choice(OTHERS)
    copy, key = document.copy(), dice.choice(keys)
    copy[key] = changed(copy[key], dice)
    return copy


@pytest.mark.parametrize("name", DAMAGED)
def test_damaged_file_gives_table_or_text(probe: Probe, tmp_path: Path, name: str) -> None:
    dice, data = Random(name), MYCOBOT.parent.with_name(name).joinpath("edition.json").read_bytes()
    document = json.loads(data)
    for number in range(80):
        at, path = dice.randrange(len(data)), tmp_path / f"{number}.json"
        cut = data[:at] + dice.choice([b"", data[at + 9 :], dice.randbytes(1) + data[at + 1 :]])
        path.write_bytes(dice.choice([cut, json.dumps(changed(document, dice)).encode()]))
        sent = [(size, dice.choice(document["commands"])["id"]) for size in (2, 3, 5) * 9]
        frames = [f"fefe{size:02x}{command:02x}" + "fa" * (size - 1) for size, command in sent]
        directions = dice.choices(DIRECTIONS, k=len(frames))
        steps = [
            ["decode", str(path), direction, frame] for direction, frame in zip(directions, frames)
        ]
        assert all(text is None or " " in text for text in probe.ask(steps))


def test_error_text_names_the_part_of_the_file_that_is_wrong(probe: Probe, tmp_path: Path) -> None:
    text, deadline = MYCOBOT.read_text("utf-8"), '"deadline_ms": 500, "reply"'
    version, wrong = '"version": 3', deadline.replace("500", '"x"')
    joint, wire = '"name": "joint", "type": "joint"', '"kind": "quantity", "wire": "byte"'
    fine = text.replace(wire, f'{wire}, "scale": "9223372036854775807/3"', 1)
    scale = "a scale is zero, or too fine for an exact double"
    why = 'command is_power_on: deadline_ms: invalid type: string "x", expected u64'
    files = {
        "the file has version 4 of the format, not 3": text.replace(version, '"version": 4', 1),
        why: text.replace(deadline, wrong, 1),
        # The default in physical units is beyond 64 bits.
        f"command send_angle: request: field joint: type joint: {scale}": fine.replace(
            joint, f'{joint}, "default": [6]'
        ),
        "the file is not JSON: recursion limit exceeded at line 1 column 128": "[" * 100_000,
    }
    paths = [tmp_path / f"{number}.json" for number in range(len(files))]
    for path, file in zip(paths, files.values()):
        path.write_text(file, encoding="utf-8")
    assert probe.ask([["read", str(path)] for path in paths]) == [*files]


def test_short_file_cannot_fill_the_memory(probe: Probe, tmp_path: Path) -> None:
    document, path = json.loads(MYCOBOT.read_text("utf-8")), tmp_path / "edition.json"
    document["types"] += [WIDE, ROW]
    document["commands"][0]["reply"] = [[{"name": "row", "type": "row"}]]
    path.write_text(json.dumps(document))
    assert path.stat().st_size < 1 << 20
    [why] = probe.ask([["read", str(path)]])
    assert why.endswith("all types and messages take too much memory")
