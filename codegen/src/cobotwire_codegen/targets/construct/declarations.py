"""Expresses the messages of an edition as calls of construct's classes."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen import lower
from cobotwire_codegen.errors import Problem, SpecError
from cobotwire_codegen.model import Chars, Command, Edition, Field, Variant
from cobotwire_codegen.model.frame import Direction
from cobotwire_codegen.render.literal import Call, Name, literal
from cobotwire_codegen.targets.construct.types import Declaration, Types

Key = tuple[str, str, int]
DIRECTIONS: tuple[Direction, ...] = ("request", "reply")


class Declarations:
    """The messages of an edition, and the types that they need."""

    def __init__(self, edition: Edition) -> None:
        self._frame = edition.frame
        self._commands = edition.commands
        self.types = Types()

    def messages(self) -> Iterator[tuple[Key, Call]]:
        """Yield the key and the declaration of each variant of each message."""
        for command in self._commands:
            for direction in DIRECTIONS:
                for index, variant in enumerate(command.variants(direction)):
                    yield (
                        (command.name, direction, index),
                        self._message(command, direction, variant),
                    )

    def _message(self, command: Command, direction: Direction, variant: Variant) -> Call:
        length, end = self._length(direction, variant)
        parts: dict[str, Declaration] = {_own("header", variant): Name("HEADER")}
        for part in self._frame.layout:
            if part == "address" and self._frame.address_values:
                parts[_own("address", variant)] = Name("ADDRESS")
            elif part == "length":
                parts[_own("length", variant)] = length
            elif part == "command" and self._frame.has_command(direction):
                parts[_own("id", variant)] = Call("Const", command.id, Name("COMMAND"))
        for field in variant:
            made = self._field(command, direction, field, variant)
            # Fields with the same later selector read it ahead once: before the first of them.
            parts |= {name: part for name, part in made.items() if name not in parts}
        if self._frame.check is not None:
            parts[_own("check", variant)] = Name("CHECK")
        if self._frame.footer:
            parts[_own("footer", variant)] = Name("FOOTER")
        return Call("Struct", **parts, **{_own("end", variant): end})

    def _length(self, direction: Direction, variant: Variant) -> tuple[Call, Declaration]:
        """Return LEN and the end: a constant, or computed from the elements of fields that vary."""
        base = self._fixed_length(direction, variant)
        varying = [_elements(field) for field in variant if field.type.varies]
        if not varying:
            return Call("Const", base, Name("LENGTH")), Name("Terminated")
        end = Call("end", _own("length", variant), base, *varying)
        return Call("length", base, *varying), end

    def _fixed_length(self, direction: Direction, variant: Variant) -> int:
        """Return LEN of a message in which fields that vary have no elements."""
        size = sum(field.type.size for field in variant if not field.type.varies)
        return self._frame.length(size, direction)

    def _field(
        self, command: Command, direction: Direction, field: Field, variant: Variant
    ) -> dict[str, Declaration]:
        """Return the declaration of a field, after that of a selector that is read ahead."""
        if field.selector:
            return self._selected(field, variant)
        count = self._count(command, direction, field, variant)
        declared = self.types.of(field, field.type, count)
        if field.counts:
            declared = Call("counting", field.counts, declared, *_encoding(field, variant))
        return {field.name: declared}

    def _selected(self, field: Field, variant: Variant) -> dict[str, Declaration]:
        names = [other.name for other in variant]
        here, there = names.index(field.name), names.index(field.selector)
        selector, found = field.selector, {}
        if there > here:
            # `check` accepts selectors and cases of one size only.
            distance = sum(other.type.size for other in variant[here:there])
            ahead = self.types.of(variant[there], variant[there].type, 1)
            found[f"{selector}_ahead"] = Call("ahead", selector, distance, ahead)
            selector = f"{selector}_ahead"
        pairs = [
            (value, self.types.of(field, type, 1))
            for when, type in lower.cases(field)
            for value in when
        ]
        return {**found, field.name: Call("pick", selector, *pairs)}

    def _count(
        self, command: Command, direction: Direction, field: Field, variant: Variant
    ) -> Name | int:
        """Return how many elements a field has: a number, or a function of the context."""
        least, most = field.type.sizes
        if not field.type.varies:
            return least
        counter = next((other.name for other in variant if other.counts == field.name), "")
        if counter:
            return Name(literal(Call("counted", counter, least, most)))
        others = []
        for other in variant:
            if other.type.varies and other is not field:
                counter = next(each.name for each in variant if each.counts == other.name)
                if variant.index(field) < [each.name for each in variant].index(counter):
                    message = (
                        f"construct cannot express {field.name} of {command.name}: it ends where "
                        f"{counter} begins, which says how long the message is"
                    )
                    raise SpecError([Problem(field.place, "unsupported-type", message)])
                others.append((counter, other.type.element_size))
        base = self._fixed_length(direction, variant)
        size, length = field.type.element_size, _own("length", variant)
        return Name(literal(Call("to_the_end", length, base, size, least, most, *others)))


def _own(part: str, variant: Variant) -> str:
    """Return the name of a part of the frame; the prefix distinguishes it from fields."""
    name = f"frame_{part}"
    while name in {field.name for field in variant}:
        name += "_"
    return name


def _elements(field: Field) -> tuple[str, int] | tuple[str, int, str]:
    """Return the name of a field that varies, the size of an element, and a text's encoding."""
    name, size = field.name, field.type.element_size
    return (name, size, field.type.encoding) if isinstance(field.type, Chars) else (name, size)


def _encoding(field: Field, variant: Variant) -> tuple[str, ...]:
    """Return the encoding of the text that a field counts, if it is one."""
    listed = next(other for other in variant if other.name == field.counts)
    return (listed.type.encoding,) if isinstance(listed.type, Chars) else ()
