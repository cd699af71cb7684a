"""``diff`` reports a change of any field of the model, alone or among random changes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import vectors
from cobotwire_codegen import model
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.catalogue import CRCS
from cobotwire_codegen.diff import diff
from cobotwire_codegen.errors import Place
from cobotwire_codegen.model import Edition

HERE = Path(__file__).parent
PLACE = Place("test", 1, 1)
# Fields that hold a position in the spec, or that follow from other fields.
PLACES = ("place", "root", "gone", "by_role", "read_by")
RECORDS = [
    item
    for item in vars(model).values()
    if isinstance(item, type)
    and is_dataclass(item)
    and item.__module__.startswith(model.__name__)
    # Frames of the small spec have a footer and no check; a test below adds one. ReadBack follows
    # from effects.
    and item not in (model.FrameCheck, model.ReadBack)
]
FIELDS = [
    (record, field.name)
    for record in RECORDS
    for field in fields(record)
    if field.name not in PLACES
]
# Words from closed lists become other words of the same list.
OTHER = {"big": "little", "little": "big", "request": "reply", "reply": "request"}
OTHER |= {"integer": "float", "ascii": "utf-8"}
OTHER |= {"": "required", "required": "optional", "optional": ""}
# New values for fields that are empty wherever the small specs have them.
NEW: dict[str, Any] = {
    "text": model.Text(PLACE, "Said", ("a ",), (("b", "B."),), "", 5),
    "disputed": (model.Dispute(PLACE, "It does.", "So.", "low", ()),),
    "check": model.FrameCheck("sum", "command", 1, "big", None),
    "crc": CRCS["crc16-modbus"],
    "address_range": (3, 4),
    "refused": (("new", (1,)),),
    "rejected": ("bad-length", 2),
    "source": ((1, 2),),
    "samples": ((("new", (1, 2)),),),
    "agrees_with": ("get_pose",),
    "lines": ((1, 2),),
    "shares_id": ("get_pose",),
    "accepted": (3,),
    "meanings": ((1, 2, "New."),),
    "printed": b"\xfe",
    "default": (1,),
    "arguments": ("new",),
    "options": (("speed", "new"),),
    "example": 3,
    "line": 3,
}
EMPTY: tuple[Any, ...] = (None, (), ((),))


@lru_cache
def small(file: str) -> Edition:
    return build_edition(HERE / f"{file}.yaml", HERE)


@lru_cache
def spots(file: str) -> tuple[tuple[type, str, tuple[str | int, ...]], ...]:
    """Return every field of every record of a small spec: the record, the field, its path."""
    return tuple(_spots(small(file), ()))


def _spots(value: Any, path: tuple[str | int, ...]) -> Iterator[Any]:
    if isinstance(value, tuple):
        for index, item in enumerate(value):
            yield from _spots(item, (*path, index))
    elif type(value) in RECORDS:
        for field in fields(value):
            part = getattr(value, field.name)
            # A selector without cases, or cases without a selector, is not a valid model.
            if field.name not in PLACES and not (field.name in ("selector", "cases") and not part):
                yield type(value), field.name, (*path, field.name)
                # The type of a state is one of the edition's types.
                if not isinstance(value, model.State):
                    yield from _spots(part, (*path, field.name))


@lru_cache
def stated() -> dict[tuple[type, str], Any]:
    """Return a value of each field of each record, if a small spec states one."""
    found: dict[tuple[type, str], Any] = {}
    for file in ("base", "delta"):
        for record, field, path in spots(file):
            value: Any = small(file)
            for step in path:
                value = value[step] if isinstance(step, int) else getattr(value, step)
            if value not in EMPTY:
                found.setdefault((record, field), value)
    return found


def changed(value: Any, path: tuple[str | int, ...]) -> Any:
    """Return the model with another value at a path."""
    step, rest = path[0], path[1:]
    if isinstance(step, int):
        return (*value[:step], changed(value[step], rest), *value[step + 1 :])
    part = getattr(value, step)
    return replace(value, **{step: changed(part, rest) if rest else other(type(value), step, part)})


def other(record: type, field: str, value: Any) -> Any:
    """Return another value of the same kind for a field of a record."""
    if value in EMPTY:
        return stated()[record, field] if (record, field) in stated() else NEW[field]
    if isinstance(value, bool):
        return not value
    if isinstance(value, int | Fraction):
        return value + 1
    if isinstance(value, str):
        return OTHER[value] if field in ("order", "direction", "echo", "encoding") else value + "x"
    if isinstance(value, bytes):
        return value + b"\x01"
    if isinstance(value, tuple):
        return (other(record, field, value[0]), *value[1:])
    first = next(part.name for part in fields(value) if part.name not in PLACES)
    return replace(value, **{first: other(type(value), first, getattr(value, first))})


def content(value: Any) -> Any:
    """Return an edition's content without its places, independently of the code under test."""
    if isinstance(value, tuple):
        return [content(part) for part in value]
    if is_dataclass(value) and not isinstance(value, type):
        parts = {
            f.name: content(getattr(value, f.name)) for f in fields(value) if f.name not in PLACES
        }
        return {"record": type(value).__name__, **parts}
    return value


@pytest.mark.parametrize("field", [field.name for field in fields(model.FrameCheck)])
def test_diff_finds_a_change_of_any_field_of_a_check(field: str) -> None:
    base = small("base")
    before = replace(base, frame=replace(base.frame, check=NEW["check"]))
    after = changed(before, ("frame", "check", field))
    assert [finding.rule for finding in diff(before, after)] == ["check-changed"]


@pytest.mark.parametrize(("record", "field"), FIELDS, ids=[f"{r.__name__}.{f}" for r, f in FIELDS])
def test_diff_finds_a_change_of_any_field(record: type, field: str) -> None:
    met = 0
    for file in ("base", "delta"):
        for owner, name, path in spots(file):
            if (owner, name) == (record, field):
                met += 1
                new = changed(small(file), path)
                assert diff(small(file), new), path
                assert diff(new, small(file)), path
    assert met, "the small spec must use every field of the model"


@given(st.lists(st.integers(0, 10_000), min_size=1, max_size=4))
def test_diff_of_random_specs_has_findings_exactly_if_they_differ(chosen: list[int]) -> None:
    old = new = small("base")
    for number in chosen:
        _, _, path = spots("base")[number % len(spots("base"))]
        try:
            new = changed(new, path)
        except (IndexError, KeyError, AttributeError):
            continue  # an earlier change removed this path
    assert bool(diff(old, new)) == (content(old) != content(new))


def moved(value: Any) -> Any:
    """Return a part of a model with every position one line further down."""
    if isinstance(value, Place):
        return replace(value, line=value.line + 1)
    if isinstance(value, tuple):
        return tuple(map(moved, value))
    if is_dataclass(value) and not isinstance(value, type):
        return replace(value, **{f.name: moved(getattr(value, f.name)) for f in fields(value)})
    return value


def test_edition_has_no_difference_from_itself_at_other_places() -> None:
    # Without other positions, the parts would be equal, and ``diff`` would not look into them.
    assert moved(vectors.edition()).commands[0] != vectors.edition().commands[0]
    assert diff(vectors.edition(), moved(vectors.edition())) == ()
    assert diff(vectors.edition(), vectors.edition()) == ()
