"""Compares what two editions state about their robots."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from cobotwire_codegen.diff import prose
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.model import Geometry, Robot
from cobotwire_codegen.publish_robot import is_coupled

_PARTS = ("geometry", "motion", "encoders", "gripper", "servos", "error_codes")
_LISTS = ("joint_limits", "start_angles")


def robot_changes(old: Robot, new: Robot) -> Iterator[Finding]:
    """Compare the parts of two robots, and how they are explained."""
    yield from prose.doc("edition/geometry_unknown", old.geometry_unknown, new.geometry_unknown)
    for name in (*_PARTS, *_LISTS):
        before, after = getattr(old, name), getattr(new, name)
        where = f"edition/{name}"
        if _words(before) != _words(after):
            yield finding(f"{name.replace('_', '-')}-changed", where, _words(before), _words(after))
        elif name in _PARTS and before is not None and after is not None:
            yield from prose.doc(where, before.doc, after.doc)


def _words(part: Any) -> str:
    """Return what a part states, without its explanation, in one line."""
    if part is None or part == ():
        return "not stated"
    if isinstance(part, Geometry):
        return "; ".join(
            _fields(link, () if is_coupled(part) else ("turned_by",)) for link in part.links
        )
    return _value(part) if isinstance(part, tuple) else _fields(part, ("doc",))


def _fields(part: Any, hidden: tuple[str, ...]) -> str:
    stated = ((name, getattr(part, name)) for name in part.__slots__ if name not in hidden)
    return ", ".join(
        f"{name.replace('_', ' ')} {_value(value)}" for name, value in stated if value is not None
    )


def _value(value: Any) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(map(_value, value))}]"
    return str(value) if isinstance(value, Fraction | int | str) else repr(value)
