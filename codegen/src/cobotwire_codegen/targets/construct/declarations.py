"""Expresses the model as calls of construct's classes."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen import lower
from cobotwire_codegen.model import (
    Command,
    Edition,
    Enum,
    Field,
    Flag,
    Quantity,
    Type,
    Value,
    Variant,
)
from cobotwire_codegen.render.literal import Call, Name, literal
from cobotwire_codegen.wire import size

Key = tuple[str, str, int]

# The names that the declarations use themselves.
_OWN_NAMES = {f"frame_{part}" for part in ("header", "length", "id", "footer", "end")}
_OWN_CONSTANTS = ("HEADER", "FOOTER", "MESSAGES")


class Declarations:
    """The messages and their numbers; equal numbers are declared once, by their type's name."""

    def __init__(self, edition: Edition) -> None:
        if edition.frame.check is not None or edition.frame.addresses:
            raise ValueError(
                f"{edition.name}: construct needs frames with a footer and without an address"
            )
        self._edition = edition
        self.types: dict[str, Call] = {}
        self._names: dict[str, str] = {}

    def messages(self) -> Iterator[tuple[Key, Call]]:
        """Yield the key and the declaration of each variant of each message."""
        for command in self._edition.commands:
            for direction in ("request", "reply"):
                variants = command.requests if direction == "request" else command.replies
                for index, variant in enumerate(variants):
                    key = (command.name, direction, index)
                    yield key, self._frame(command, variant)

    def _frame(self, command: Command, variant: Variant) -> Call:
        frame = self._edition.frame
        # The prefix distinguishes these names from fields; some messages have a field named end.
        data = sum(size(field.type) for field in variant)
        own = sorted(_OWN_NAMES & {field.name for field in variant})
        if own:
            raise ValueError(f"{command.name}: the field {own[0]} has a name of the declarations")
        parts = {
            "frame_header": Name("HEADER"),
            "frame_length": Call("Const", 1 + data + frame.check_size, Name("Byte")),
            "frame_id": Call("Const", command.id, Name("Byte")),
            **self._ahead(variant),
            **{field.name: self._field(field, variant) for field in variant},
            "frame_footer": Name("FOOTER"),
            "frame_end": Name("Terminated"),
        }
        return Call("Struct", **parts)

    def _ahead(self, variant: Variant) -> dict[str, Call]:
        """Return declarations that read each selector that follows the field it decides."""
        found = {}
        at = len(self._edition.frame.header) + 2
        for field in variant:
            later = variant[variant.index(field) + 1 :]
            for selector in (other for other in later if other.name == field.selector):
                between = variant[variant.index(field) : variant.index(selector)]
                offset = at + sum(size(other.type) for other in between)
                found[_name_ahead(selector.name)] = Call(
                    "Pointer", offset, self._plain(selector, selector.type)
                )
            at += size(field.type)
        return found

    def _field(self, field: Field, variant: Variant) -> Call | Name:
        if not field.selector:
            return self._plain(field, field.type)
        before = [other.name for other in variant[: variant.index(field)]]
        selector = field.selector if field.selector in before else _name_ahead(field.selector)
        pairs = [
            (value, self._plain(field, type)) for when, type in lower.cases(field) for value in when
        ]
        return Call("pick", selector, *pairs)

    def _plain(self, field: Field, type: Type) -> Call | Name:
        if isinstance(type, Value):
            return Call("Struct", **{label: self._number(item) for label, item in type.items})
        assert isinstance(type, Quantity | Enum | Flag), "other types are refused"
        number = self._number(type)
        return number if field.const is None else Call("Const", field.const, number)

    def _number(self, type: Quantity | Enum | Flag) -> Name:
        """Return the name under which the type's number is declared."""
        expression = _expression(type)
        text = literal(expression)
        if text not in self._names:
            name = type.name.upper()
            name += "_" if name in _OWN_CONSTANTS else ""
            alike = sum(other.rpartition("_")[0] == name or other == name for other in self.types)
            self._names[text] = f"{name}_{alike + 1}" if alike else name
            self.types[self._names[text]] = expression
        return Name(self._names[text])


def _expression(type: Quantity | Enum | Flag) -> Call:
    wire = type.wire
    little = wire.order == "little"
    if isinstance(type, Flag):
        return Call("flag", Call("number", wire.width, little, wire.signed_at, (0, 1)))
    if isinstance(type, Enum):
        values = tuple(member.value for member in type.members)
        number = Call("number", wire.width, little, wire.signed_at, values)
        return Call("Enum", number, **{member.name: member.value for member in type.members})
    lowest, highest = map(int, type.bounds)
    allowed = type.choices or Call("between", lowest, highest)
    scale = (type.scale.numerator, type.scale.denominator)
    return Call("number", wire.width, little, wire.signed_at, allowed, *(scale * (scale != (1, 1))))


def _name_ahead(name: str) -> str:
    return f"{name}_ahead"
