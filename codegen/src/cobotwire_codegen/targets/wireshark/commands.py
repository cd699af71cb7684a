"""Turns commands into the dissector's tables: how to read each message, which fields show it."""

from __future__ import annotations

from typing import Any

from cobotwire_codegen import lower
from cobotwire_codegen.model import (
    Chars,
    Command,
    Edition,
    Field,
    Listed,
    Octets,
    Text,
    Type,
    Variant,
)
from cobotwire_codegen.targets.wireshark.fields import Declared
from cobotwire_codegen.targets.wireshark.leaves import Leaf, leaves
from cobotwire_codegen.targets.wireshark.lua import Name

# The session has the same limits: a real arm sent a reply 727 ms late, and a motion may be
# acknowledged at its end.
SHORTEST_WAIT = 1000
MOTION_WAIT = 60_000


class Commands:
    """All commands in the order in which they are tried, and the numbers in their fields."""

    def __init__(self, edition: Edition, declared: Declared) -> None:
        """Lower every command, and declare the fields that they need."""
        self._declared = declared
        self.numbers: list[dict[str, Any]] = []
        self.all = [self._command(command) for command in edition.commands]

    def _command(self, command: Command) -> dict[str, Any]:
        made: dict[str, Any] = {"id": command.id, "name": command.name, "wait_ms": _wait(command)}
        for direction in ("request", "reply"):
            variants = command.variants(direction)
            made[direction] = [self._variant(command, variant) for variant in variants]
        flags = {"awaits_reply": command.awaits_reply, "ack": command.ack, "event": command.event}
        made |= {name: True for name, given in flags.items() if given}
        if command.accepted:
            made["accepted"] = list(command.accepted)
        texts = {"reply_text": command.text, "request_text": command.request_text}
        return made | {name: self._text(text) for name, text in texts.items() if text}

    def _variant(self, command: Command, variant: Variant) -> list[dict[str, Any]]:
        return [self._field(command, field, variant) for field in variant]

    def _field(self, command: Command, field: Field, variant: Variant) -> dict[str, Any]:
        names = [other.name for other in variant]
        element = field.type.of if isinstance(field.type, Listed) else field.type
        labels = dict(zip(element.choices, lower.labels(element)))
        # Lists count from 1 in Lua, so 0 means that there is no group, selector or list.
        optional = {
            "flag": lower.kind(element) == "flag",
            "group": self._declared.group(command, field),
            "choices": list(lower.field_choices(field)),
            "labels": labels if field.const is None else {},
            "selector": lower.selector(field, variant) + 1,
            "echo": bool(field.echo),
            "counts": names.index(field.counts) + 1 if field.counts else 0,
            **_shape(field.type),
        }
        cases = [self._case(command, field, when, type) for when, type in lower.cases(field)]
        return {"name": field.name, **{k: v for k, v in optional.items() if v}, "cases": cases}

    def _case(
        self, command: Command, field: Field, when: tuple[int, ...], type: Type
    ) -> dict[str, Any]:
        numbers = [self._number(command, field, leaf) for leaf in leaves(type)]
        return {"when": list(when), "numbers": numbers} if when else {"numbers": numbers}

    def _number(self, command: Command, field: Field, leaf: Leaf) -> Name:
        """Return the index of the number in the list."""
        made = leaf.reading | {"shown": self._declared.leaf(command, field, leaf)}
        if made not in self.numbers:
            self.numbers.append(made)
        return Name(f"NUMBERS[{self.numbers.index(made) + 1}]")

    def _text(self, text: Text) -> dict[str, Any]:
        return {
            "prefixes": list(text.prefixes),
            "fields": [name for name, _ in text.fields],
            "shown": [self._declared.text(name, doc) for name, doc in text.fields],
            "suffix": text.suffix,
            "silence_ms": text.silence_ms,
        }


def _shape(type: Type) -> dict[str, Any]:
    """Return what distinguishes lists, bytes and texts from a single value.

    ``size`` is the smallest and the largest number of elements: bytes, unless it is a list.
    """
    element = type.of if isinstance(type, Listed) else type
    shape: dict[str, Any] = {}
    if isinstance(type, Listed):
        shape |= {"list": True}
    if isinstance(type, Listed | Octets | Chars):
        shape |= {"size": list(type.sizes)}
    if isinstance(element, Octets):
        shape |= {"bytes": True}
    if isinstance(element, Chars):
        shape |= {"encoding": element.encoding}
        shape |= {} if element.padding is None else {"padding": bytes([element.padding])}
        shape |= {"letters": element.size} if isinstance(type, Listed) else {}
    return shape


def _wait(command: Command) -> int:
    """Return how many milliseconds after the request a reply or acknowledgement can come."""
    if command.ack and command.safety == "motion":
        return MOTION_WAIT
    return max(command.deadline_ms, SHORTEST_WAIT)
