"""Records do what frozen dataclasses with slots do."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
from typing import Any, ClassVar

import pytest

from cobotwire.protocol.records import field, record
from command_line import run_code


@record(frozen=True, slots=True)
class Point:
    """Two numbers, and what is derived from them."""

    x: int
    y: int = 2
    unit: ClassVar[str] = "mm"
    total: int = field(init=False, repr=False, compare=False)
    seen: list[int] = field(default_factory=list, init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "total", self.x + self.y)


@record(frozen=True, slots=True, kw_only=True)
class Base:
    """Fields that are passed by name."""

    a: int
    b: int = 5


@record(frozen=True, slots=True, kw_only=True)
class Derived(Base):
    """One more field, without a default."""

    c: str


def test_record_behaves_as_a_dataclass() -> None:
    point = Point(1)
    assert (point.x, point.y, point.total, point.seen) == (1, 2, 3, [])
    assert point == Point(x=1, y=2)
    assert point != Point(1, 3)
    assert point.__eq__((1, 2)) is NotImplemented
    assert hash(point) == hash(Point(1))
    assert repr(point) == "Point(x=1, y=2)"
    assert Point.__match_args__ == ("x", "y")
    assert Point.unit == "mm"
    assert Point(1).seen is not point.seen


def test_fields_of_a_base_come_first_and_are_passed_by_name() -> None:
    derived = Derived(c="c", a=1)
    assert repr(derived) == "Derived(a=1, b=5, c='c')"
    assert derived != Base(a=1)
    assert [each.name for each in dataclasses.fields(Derived)] == ["a", "b", "c"]


def test_functions_of_dataclasses_take_records() -> None:
    point = Point(1)
    assert dataclasses.is_dataclass(point)
    assert dataclasses.replace(point, y=7) == Point(1, 7)
    fields = {"x": 1, "y": 2, "total": 3, "seen": []}
    assert dataclasses.asdict(point) == fields
    assert list(inspect.signature(Point).parameters) == ["x", "y"]
    assert inspect.signature(Point).parameters["y"].default == 2


def test_copies_of_records_are_equal() -> None:
    point = Point(1, 9)
    for twin in (copy.copy(point), copy.deepcopy(point), pickle.loads(pickle.dumps(point))):
        assert twin == point
        assert (twin.total, twin.seen) == (10, [])


def test_record_cannot_be_changed() -> None:
    point = Point(1)
    for name in ("x", "other"):
        with pytest.raises(dataclasses.FrozenInstanceError, match=name):
            setattr(point, name, 3)
    with pytest.raises(dataclasses.FrozenInstanceError, match="x"):
        del point.x
    assert not hasattr(point, "__dict__")


@pytest.mark.parametrize(
    ("kind", "arguments", "named", "error"),
    [
        (Point, (), {}, "is missing its argument 'x'"),
        (Point, (), {"y": 1}, "is missing its argument 'x'"),
        (Point, (1, 2, 3), {}, "takes 2 positional arguments but 3 were given"),
        (Point, (1,), {"z": 3}, "got an unexpected keyword argument 'z'"),
        (Point, (1,), {"x": 3}, "got multiple values for argument 'x'"),
        (Point, (1,), {"total": 3}, "got an unexpected keyword argument 'total'"),
        (Derived, (1,), {}, "takes 0 positional arguments but 1 were given"),
        (Derived, (), {"a": 1}, "is missing its argument 'c'"),
        (Derived, (), {}, "is missing its argument 'a', 'c'"),
    ],
)
def test_wrong_arguments_are_named(
    kind: Any, arguments: tuple[int, ...], named: dict[str, int], error: str
) -> None:
    with pytest.raises(TypeError, match=rf"{kind.__name__}.__init__\(\) {error}"):
        kind(*arguments, **named)


def test_client_is_opened_without_dataclasses() -> None:
    code = """
import sys
from cobotwire import MyCobot280
class Memory:
    url = "memory"
    def write(self, data): pass
    def read(self, timeout): return b""
    def close(self): pass
MyCobot280(Memory())
sys.exit(sorted({"dataclasses", "inspect"} & sys.modules.keys()) or 0)
"""
    done = run_code(code)
    assert (done.returncode, done.stderr) == (0, "")
