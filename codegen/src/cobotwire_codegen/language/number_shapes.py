"""Read numbers from the spec: whole numbers, exact fractions, ranges and lists."""

from __future__ import annotations

from fractions import Fraction

from cobotwire_codegen.language.json_schema import Schema, either
from cobotwire_codegen.language.shapes import Note, Shape, items_of
from cobotwire_codegen.load import Node, Scalar, Sequence, exact

_EXACT = r"^\s*-?[0-9]+(\.[0-9]*)?(/[0-9]+)?\s*$"


class Whole(Shape[int]):
    """A whole number, optionally with a lowest or highest value."""

    def __init__(
        self, lowest: int | None = None, highest: int | None = None, code: str = "bad-number"
    ) -> None:
        self.lowest, self.highest, self.code = lowest, highest, code
        self.blank = lowest or 0
        self.words = f"a whole number {self.bounds}".strip()

    @property
    def bounds(self) -> str:
        """The bounds in words; empty if there are none."""
        if self.lowest is not None and self.highest is not None:
            return f"in {self.lowest}..{self.highest}"
        return f"of at least {self.lowest}" if self.lowest is not None else ""

    def read(self, node: Node, subject: str, note: Note) -> int:
        """Return the number."""
        value = node.value if isinstance(node, Scalar) else None
        # In Python, True is an int; in the spec, it is not a number.
        if type(value) is not int:
            return self._wrong(node, subject, note)
        low = self.lowest is not None and value < self.lowest
        if low or (self.highest is not None and value > self.highest):
            shown = value if abs(value) < 10**40 else "a number of more than 40 digits"
            allowed = self.bounds.removeprefix("of ").removeprefix("in ")
            note(self.code, f"{subject} is {shown}; allowed: {allowed}", node.place)
            return self.blank
        return value

    def schema(self) -> Schema:
        """Return an integer with its bounds."""
        bounds = {"minimum": self.lowest, "maximum": self.highest}
        return {"type": "integer", **{k: v for k, v in bounds.items() if v is not None}}


class WholeOrMember(Shape[int | str]):
    """A whole number, or the name of a member of an enum."""

    blank = 0
    words = "a whole number or the name of a member"

    def read(self, node: Node, subject: str, note: Note) -> int | str:
        """Return the number or the name."""
        value = node.value if isinstance(node, Scalar) else None
        if isinstance(value, str) or type(value) is int:
            return value
        return self._wrong(node, subject, note)

    def schema(self) -> Schema:
        """Return an integer or a string."""
        return {"type": ["integer", "string"]}


class Span(Shape[tuple[int, int]]):
    """A whole number, or a pair of them: the lowest and the highest."""

    blank = (0, 0)
    words = "a whole number, or [lowest, highest]"

    def read(self, node: Node, subject: str, note: Note) -> tuple[int, int]:
        """Return the two numbers, which are the same if only one is given."""
        items = node.items if isinstance(node, Sequence) else (node, node)
        ends = [item.value if isinstance(item, Scalar) else None for item in items]
        if len(ends) == 2 and all(type(end) is int and 0 <= end < 2**16 for end in ends):
            low, high = ends
            if low <= high:  # type: ignore[operator]  # both are integers
                return low, high  # type: ignore[return-value]  # both are integers
        return self._wrong(node, subject, note, "bad-size")

    def schema(self) -> Schema:
        """Return a whole number, or an array of two."""
        one: Schema = {"type": "integer", "minimum": 0, "maximum": 65535}
        return either("array", {"items": one, "minItems": 2, "maxItems": 2}, one)


class Exact(Shape[Fraction]):
    """A positive number with an exact value: 1/100, 0.01 or 3."""

    blank = Fraction(1)
    words = "a positive number"

    def read(self, node: Node, subject: str, note: Note) -> Fraction:
        """Return the number as a fraction."""
        value = as_fraction(node)
        if value is None or value <= 0:
            return self._wrong(node, subject, note, "bad-number")
        return value

    def schema(self) -> Schema:
        """Return a number, or a string with a fraction."""
        return {"type": ["number", "string"], "pattern": _EXACT}


class Real(Shape[Fraction]):
    """Any number with an exact value: -110.4, 1/100 or 0."""

    blank = Fraction(0)
    words = "a number"

    def read(self, node: Node, subject: str, note: Note) -> Fraction:
        """Return the number as a fraction."""
        value = as_fraction(node)
        return self._wrong(node, subject, note, "bad-number") if value is None else value

    def schema(self) -> Schema:
        """Return a number, or a string with a fraction."""
        return {"type": ["number", "string"], "pattern": _EXACT}


class Range(Shape[tuple[Fraction, Fraction] | None]):
    """A pair of numbers, the lowest and the highest."""

    blank = None
    words = "[lowest, highest]"

    def read(self, node: Node, subject: str, note: Note) -> tuple[Fraction, Fraction] | None:
        """Return the two numbers."""
        ends = [as_fraction(item) for item in node.items] if isinstance(node, Sequence) else []
        if len(ends) == 2 and ends[0] is not None and ends[1] is not None and ends[0] <= ends[1]:
            return ends[0], ends[1]
        return self._wrong(node, subject, note, "bad-range")

    def schema(self) -> Schema:
        """Return an array of two numbers."""
        return {"type": "array", "items": Exact().schema(), "minItems": 2, "maxItems": 2}


class Numbers(Shape[tuple[int, ...]]):
    """A list of whole numbers."""

    blank = ()
    words = "a list of whole numbers"

    def read(self, node: Node, subject: str, note: Note) -> tuple[int, ...]:
        """Return the numbers."""
        found = []
        for item in items_of(node, subject, note):
            if isinstance(item, Scalar) and type(item.value) is int:
                found.append(item.value)
            else:
                note("wrong-kind", f"{subject} must be whole numbers", item.place)
        return tuple(found)

    def schema(self) -> Schema:
        """Return an array of integers."""
        return {"type": "array", "items": {"type": "integer"}, "minItems": 1}


class Reals(Shape[tuple[Fraction, ...]]):
    """A list of any numbers."""

    blank = ()
    words = "a list of numbers"

    def read(self, node: Node, subject: str, note: Note) -> tuple[Fraction, ...]:
        """Return the numbers."""
        items = items_of(node, subject, note)
        return tuple(Real().read(item, f"a number of {subject}", note) for item in items)

    def schema(self) -> Schema:
        """Return an array of numbers."""
        return {"type": "array", "items": Real().schema(), "minItems": 1}


class Ranges(Shape[tuple[tuple[Fraction, Fraction], ...]]):
    """A list of pairs of numbers, the lowest and the highest."""

    blank = ()
    words = "a list of [lowest, highest]"

    def read(self, node: Node, subject: str, note: Note) -> tuple[tuple[Fraction, Fraction], ...]:
        """Return the pairs."""
        pairs = (
            Range().read(item, f"a pair of {subject}", note)
            for item in items_of(node, subject, note)
        )
        return tuple(pair for pair in pairs if pair is not None)

    def schema(self) -> Schema:
        """Return an array of pairs."""
        return {"type": "array", "items": Range().schema(), "minItems": 1}


def as_fraction(node: Node) -> Fraction | None:
    """Return the exact number that a node holds, or None."""
    value = node.value if isinstance(node, Scalar) else None
    if isinstance(value, bool) or not isinstance(value, int | Fraction | str):
        return None
    try:
        return exact(value) if isinstance(value, str) else Fraction(value)
    except (ValueError, ZeroDivisionError):
        return None
