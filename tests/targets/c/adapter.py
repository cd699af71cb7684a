"""Offer the C code as a codec: ``cobotwire conform codec -- python -m targets.c.adapter``.

This adapter handles names and JSON, since C has neither. The C code computes every frame, value
and event. The first question names the edition.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from typing import Any

import vectors
from cobotwire_codegen.model import Quantity, Value
from cobotwire_codegen.targets.c.messages import Member, Message, messages
from targets.c.compiled import program
from targets.c.peer import CPeer, Event, Outcome, Read

Json = dict[str, Any]
CAN = [
    *(f"{do} {direction}" for do in ("encode", "decode") for direction in ("request", "reply")),
    *(f"stream {listening}" for listening in ("request", "reply", "both")),
    *("noise", "reasons"),
]


class Adapter:
    """Answer the questions about one edition."""

    def __init__(self, name: str) -> None:
        edition = vectors.edition(name)
        self._messages = messages(edition)
        self._peer = CPeer(program(edition))
        self._name = name

    def ask(self, question: Json) -> Json:
        """Return the answer to one question."""
        does = {
            "hello": self._hello,
            "encode": self._encode,
            "decode": self._decode,
            "stream": self._stream,
        }
        return {"id": question["id"]} | does[question["do"]](question)

    def _hello(self, question: Json) -> Json:
        return {"protocol": 1, "edition": self._name, "name": "cobotwire's C", "can": CAN}

    def _variants(self, question: Json) -> Iterator[tuple[int, Message]]:
        for index, message in enumerate(self._messages):
            own = (message.command.name, message.direction)
            if own == (question["command"], question["direction"]):
                yield index, message

    def _encode(self, question: Json) -> Json:
        given = question["fields"]
        for index, message in self._variants(question):
            if {member.field.name for member in message.members} != set(given):
                continue
            numbers = _numbers(message, given)
            found = None if numbers is None else self._peer.encode_values(index, numbers)
            if isinstance(found, bytes):
                return {"bytes": found.hex()}
        return {"error": "bad-value"}

    def _decode(self, question: Json) -> Json:
        data = bytes.fromhex(question["bytes"])
        if question.get("command") is None:
            found = self._peer.read(question["direction"], data)
        else:
            outcomes = [self._peer.decode(index, data) for index, _ in self._variants(question)]
            # Another variant may have the right length: its reason goes before bad-length.
            rank = {"ok": 0, "bad-length": 2}
            found = min(outcomes, key=lambda o: 0 if isinstance(o, Read) else rank.get(o.status, 1))
        if isinstance(found, Outcome):
            return {"error": found.status, "offset": found.offset}
        message = self._messages[found.message]
        return {"command": message.command.name, "fields": _fields(message, found)}

    def _stream(self, question: Json) -> Json:
        chunks = [(bytes.fromhex(chunk or ""), chunk is None) for chunk in question["chunks"]]
        found, _ = self._peer.events_by_chunk(question["direction"], chunks)
        return {"events": [list(map(_event, events)) for events in found]}


def _numbers(message: Message, given: Json) -> list[float] | None:
    """Return the given fields as the numbers of a struct; None if the struct cannot hold them."""
    numbers: list[float] = []
    for member in message.members:
        value = given[member.field.name]
        if member.field.const is not None:
            if value != member.field.const:
                return None
            continue
        parts = value if isinstance(value, list) else [value]
        if len(parts) != member.count or isinstance(value, list) != _many(member):
            return None
        if not all(map(_fits_struct, parts, _scaled(member))):
            return None
        numbers += parts
    return numbers


def _fits_struct(value: object, scaled: bool) -> bool:
    """Return whether a struct can hold the value: without a scale, only integers of 32 bits."""
    if not isinstance(value, int | float):
        return False
    return scaled or (value == value // 1 and abs(value) < 2**31)


def _many(member: Member) -> bool:
    return isinstance(member.field.type, Value)


def _scaled(member: Member) -> list[bool]:
    """Return for each number of a member whether it has a scale."""
    type = member.field.type
    parts = [part for _, part in type.items] if isinstance(type, Value) else [type]
    return [isinstance(part, Quantity) and part.scale != 1 for part in parts]


def _fields(message: Message, found: Read) -> Json:
    fields: Json = {}
    for member in message.members:
        if member.field.const is not None:
            fields[member.field.name] = member.field.const
            continue
        numbers = found.values[member.index : member.index + member.count]
        fields[member.field.name] = numbers if _many(member) else numbers[0]
    return fields


def _event(event: Event) -> Json:
    if event.reason == "ok":
        return {"frame": event.data.hex(), "offset": event.offset}
    return {"noise": event.data.hex(), "offset": event.offset, "reason": event.reason}


def main() -> None:
    """Answer questions until the input ends."""
    adapter = None
    for line in sys.stdin:
        question = json.loads(line)
        adapter = adapter or Adapter(question["edition"])
        print(json.dumps(adapter.ask(question)), flush=True)


if __name__ == "__main__":
    main()
