"""Builds the tables that the C codec interprets; equal runs are stored once.

The general tables are for editions with floats, bits, bytes, texts or lists. All other editions
have only integers, and smaller tables.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from cobotwire_codegen import lower
from cobotwire_codegen.model import Chars, Edition, Field, Listed
from cobotwire_codegen.targets.c.messages import DIRECTIONS, Member, Message, messages
from cobotwire_codegen.targets.c.names import bits, integer, string
from cobotwire_codegen.targets.c.storage import Leaf

# Marks in the tables of editions that have only integers; the header has no names for them.
CONSTANT = 0xFF
NO_SELECTOR = 0xFF


class Pool:
    """An array of rows that stores equal runs once."""

    def __init__(self) -> None:
        self.rows: list[str] = []

    def place(self, run: Sequence[str]) -> int:
        """Return where the run starts in the array; append it if it is missing."""
        wanted = list(run)
        for start in range(len(self.rows) - len(wanted) + 1):
            if self.rows[start : start + len(wanted)] == wanted:
                return start
        self.rows += wanted
        return len(self.rows) - len(wanted)


class Tables:
    """The arrays of one edition, each as the text of its elements."""

    def __init__(self, edition: Edition) -> None:
        self._prefix = edition.name
        self.messages = messages(edition)
        members = [member for message in self.messages for member in message.members]
        leaves = list(_leaves(members))
        self.general = any(member.storage.general for member in members)
        self.floats = any(leaf.kind in ("FLOAT", "DOUBLE") for leaf in leaves)
        self.doubles = any(leaf.kind == "DOUBLE" for leaf in leaves)
        self.unions = any(member.storage.element.endswith("_number_t") for member in members)
        self.utf8 = any(_utf8(member.field) for member in members)
        self.raw_bits = 64 if any(_wide(leaf.number) for leaf in leaves) else 32
        self.wide = self.raw_bits == 64 or self.doubles
        self.numbers, self.raw_values, self.cases, self.fields = Pool(), Pool(), Pool(), Pool()
        self.lists = Pool()
        self.listed = any(map(_lists_numbers, members))
        self.rows = [self._message(message) for message in self.messages]
        self.lengths = {each: self._lengths(edition, each) for each in DIRECTIONS}
        self.most = max((message.count for message in self.messages), default=0)
        self.most_fields = max((len(message.members) for message in self.messages), default=0)
        self.most_elements = max((member.storage.count for member in members), default=0)
        self.names = [string(message.command.name) for message in self.messages]
        self.field_names = [_row(_names(message)) for message in self.messages]

    def _lengths(self, edition: Edition, direction: str) -> list[str]:
        frame = edition.frame
        if frame.length_number.width > 1:
            return []
        own = [message for message in self.messages if message.direction == direction]
        sizes = [size for each in own for size in each.sizes(frame.maximum_data)]
        return bits([frame.length(size, own[0].direction) for size in sizes])

    def _message(self, message: Message) -> str:
        variant = tuple(member.field for member in message.members)
        fields = [self._field(message, member, variant) for member in message.members]
        place = self.fields.place(fields)
        direction = message.direction.upper()
        size = "" if self.general else f"{message.size}, "
        return f"{{{place}, 0x{message.command.id:02X}, {direction}, {size}{len(fields)}}}"

    def _field(self, message: Message, member: Member, variant: tuple[Field, ...]) -> str:
        field = member.field
        choices = _choices(field)
        cases = [
            self._case(when, leaves)
            for (when, _), leaves in zip(lower.cases(field), member.storage.cases)
        ]
        selector = lower.selector(field, variant)
        parts = [
            self.cases.place(cases),
            self.raw_values.place([integer(choice) for choice in choices]),
            len(cases),
            len(choices),
            NO_SELECTOR if selector < 0 else selector,
            *(self._general(message, member) if self.general else [_index(member)]),
        ]
        return "{" + ", ".join(map(str, parts)) + "}"

    def _general(self, message: Message, member: Member) -> list[str]:
        """Return where a field is in its struct, and its row in the table of lists."""
        struct, stored = f"{self._prefix}_{message.symbol}_t", member.storage
        names = [each.field.name for each in message.members]
        counts = names.index(member.field.counts) if member.field.counts else NO_SELECTOR
        several = stored.each * stored.most > 1 or stored.varies
        parts = [
            f"offsetof({struct}, {member.counter})" if member.counter else "CONSTANT",
            f"sizeof({stored.element})" if several else "0",
            str(stored.least),
            str(stored.most),
            str(stored.each),
            str(counts),
            _utf8(member.field) or "NO_TEXT",
        ]
        place = f"offsetof({struct}, {member.name})" if member.count else "CONSTANT"
        return [place, str(self.lists.place([_row(parts)]))]

    def _case(self, when: tuple[int, ...], leaves: tuple[Leaf, ...]) -> str:
        picked = self.raw_values.place([integer(value) for value in when])
        numbers = self.numbers.place([self._number(leaf) for leaf in leaves])
        return f"{{{picked}, {numbers}, {len(when)}, {len(leaves)}}}"

    def _number(self, leaf: Leaf) -> str:
        number = leaf.number
        low, high = integer(number["minimum"]), integer(number["maximum"])
        little = "1" if number["order"] == "little" else "0"
        parts = [f"{number['signed_at']}", low, high, f"{number['width']}", little]
        choices = [integer(choice) for choice in _not_all(number.get("choices", ()))]
        listed = [f"{len(choices)}", f"{self.raw_values.place(choices)}"]
        if self.general:
            count = number.get("bits", 0) or 8 * number["width"]
            parts += [f"{number.get('shift', 0)}", f"{count}", f"{int(number.get('more', False))}"]
            parts += [leaf.kind, *listed, leaf.place]
        elif self.listed:
            parts += listed
        return _row(parts)


def _index(member: Member) -> str:
    return str(member.index if member.count else CONSTANT)


def _names(message: Message) -> list[str]:
    return [string(member.field.name) for member in message.members] or ['""']


def _row(parts: list[str]) -> str:
    return "{" + ", ".join(parts) + "}"


def _choices(field: Field) -> tuple[int, ...]:
    """Return the choices of a field; empty if its bounds allow the same values."""
    choices = lower.field_choices(field)
    return choices if field.const is not None else _not_all(choices)


def _not_all(choices: Sequence[int]) -> tuple[int, ...]:
    """Return the choices; empty if every integer between the lowest and the highest is one."""
    every = max(choices, default=0) - min(choices, default=1) + 1
    return () if len(set(choices)) == every else tuple(choices)


def _lists_numbers(member: Member) -> bool:
    """Return whether the numbers of a field have choices that the field itself does not have."""
    leaves = (leaf for case in member.storage.cases for leaf in case)
    listed = any(_not_all(leaf.number.get("choices", ())) for leaf in leaves)
    return listed and not _choices(member.field)


def _leaves(members: list[Member]) -> Iterator[Leaf]:
    for member in members:
        for leaves in member.storage.cases:
            yield from leaves


def _wide(number: dict[str, Any]) -> bool:
    """Return whether the wire can carry integers, legal or not, that int32_t cannot hold."""
    if number.get("encoding") == "float":
        return False
    top = (1 << (number.get("bits") or 8 * number["width"])) - 1
    signed_at = min(number["signed_at"], top)
    return bool(signed_at >= 2**31 or (signed_at < top and signed_at - top < -(2**31)))


def _utf8(field: Field) -> str:
    """Return how a field holds UTF-8: one text, or one in each element; empty if it holds none."""
    listed = isinstance(field.type, Listed)
    type = field.type.of if isinstance(field.type, Listed) else field.type
    if not isinstance(type, Chars) or type.encoding != "utf-8":
        return ""
    return "EACH_TEXT" if listed else "WHOLE_TEXT"
