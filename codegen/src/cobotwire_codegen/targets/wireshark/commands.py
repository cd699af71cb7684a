"""Turns commands into the dissector's tables: how to read each message, which fields show it."""

from __future__ import annotations

from typing import Any

from cobotwire_codegen import lower, wire
from cobotwire_codegen.model import Command, Edition, Field, Text, Type, Variant
from cobotwire_codegen.render.words import units
from cobotwire_codegen.targets.wireshark.fields import Declared
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
        flags = {"awaits_reply": command.awaits_reply, "ack": command.ack}
        made |= {name: True for name, given in flags.items() if given}
        texts = {"reply_text": command.text, "request_text": command.request_text}
        return made | {name: self._text(text) for name, text in texts.items() if text}

    def _variant(self, command: Command, variant: Variant) -> dict[str, Any]:
        size = sum(wire.size(field.type) for field in variant)
        return {"size": size, "fields": [self._field(command, field, variant) for field in variant]}

    def _field(self, command: Command, field: Field, variant: Variant) -> dict[str, Any]:
        labels = dict(zip(lower.field_choices(field), lower.labels(field.type)))
        # Lists count from 1 in Lua, so 0 means that there is no group or selector.
        optional = {
            "flag": lower.kind(field.type) == "flag",
            "group": self._declared.group(command, field),
            "choices": list(lower.field_choices(field)),
            "labels": labels if field.const is None else {},
            "selector": lower.selector(field, variant) + 1,
            "echo": bool(field.echo),
        }
        cases = [self._case(command, field, when, type) for when, type in lower.cases(field)]
        return {"name": field.name, **{k: v for k, v in optional.items() if v}, "cases": cases}

    def _case(
        self, command: Command, field: Field, when: tuple[int, ...], type: Type
    ) -> dict[str, Any]:
        numbers = [self._number(command, field, type, each) for each in lower.numbers(type)]
        return {"when": list(when), "numbers": numbers} if when else {"numbers": numbers}

    def _number(self, command: Command, field: Field, type: Type, number: dict[str, Any]) -> Name:
        """Return the index of the number in the list."""
        shown = self._declared.number(command, field, type, number)
        left_out: dict[str, Any] = {"name": "", "unit": ""}
        if (number["multiply"], number["divide"]) == (1, 1):
            left_out |= {"multiply": 1, "divide": 1}
        made = {k: v for k, v in number.items() if k not in left_out or v != left_out[k]}
        if "unit" in made:
            made["unit"] = units(made["unit"])
        made["shown"] = shown
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


def _wait(command: Command) -> int:
    """Return how many milliseconds after the request a reply or acknowledgement can come."""
    if command.ack and command.safety == "motion":
        return MOTION_WAIT
    return max(command.deadline_ms, SHORTEST_WAIT)
