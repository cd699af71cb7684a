"""Answer questions with one of our codecs, in the same process or for the line protocol."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import Any

from cobotwire.codec.interface import Codec, DecodedMessage, Framer, Noise
from cobotwire.conformance.codec.questions.question import Json, hexed
from cobotwire.conformance.samples.physical import plain
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Direction, Field

ABILITIES = [
    *(f"{do} {direction}" for do in ("encode", "decode") for direction in ("request", "reply")),
    *(f"stream {listening}" for listening in ("request", "reply", "both")),
    *("noise", "reasons"),
]


class OurCodec:
    """Answers questions with a codec; an ``Implementation`` in the same process."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec

    def ask(self, question: Json) -> Json:
        """Return the answer to one question."""
        does = {
            "hello": self._hello,
            "encode": self._encode,
            "decode": self._decode,
            "stream": self._stream,
        }
        return does[question["do"]](question)

    def _hello(self, question: Json) -> Json:
        return {
            "protocol": 1,
            "name": f"cobotwire {self._codec.name}",
            "edition": self._codec.table.edition,
            "can": ABILITIES,
        }

    def _encode(self, question: Json) -> Json:
        try:
            command, direction = question["command"], question["direction"]
            return {
                "bytes": hexed(encode_named(self._codec, command, direction, question["fields"]))
            }
        except UsageError as error:
            return {"error": "bad-value", "why": str(error)}

    def _decode(self, question: Json) -> Json:
        data = bytes.fromhex(question["bytes"])
        try:
            message = self._codec.decode(question["direction"], data, of=question.get("command"))
        except ProtocolError as error:
            return {"error": error.reason, "offset": error.offset, "why": str(error)}
        return {"command": message.command.name, "fields": plain_fields(message)}

    def _stream(self, question: Json) -> Json:
        framer = self._codec.framer(question["direction"])
        return {"events": [events_of(framer, chunk) for chunk in question["chunks"]]}


def events_of(framer: Framer, chunk: str | None) -> list[Json]:
    """Return the events that a framer reports after a chunk, or after a silence (None)."""
    events = framer.flush() if chunk is None else framer.feed(bytes.fromhex(chunk))
    return [
        {"noise": hexed(event.data), "offset": event.offset, "reason": event.reason}
        if isinstance(event, Noise)
        else {"frame": hexed(event.data), "offset": event.offset}
        for event in events
    ]


def encode_named(
    codec: Codec, command: str, direction: Direction, fields: Mapping[str, Any]
) -> bytes:
    """Return the frame of the first variant with exactly these fields that allows the values.

    Raises:
        UsageError: no variant has these fields, or none allows the values.
    """
    rejection: UsageError | None = None
    for index, variant in enumerate(codec.table.command(command).variants(direction)):
        names = [field.name for field in variant.fields]
        if set(names) != set(fields):
            continue
        values = [value_of(field, fields[field.name]) for field in variant.fields]
        # The values choose among variants that differ in sizes.
        sized = any(field.sizes for field in variant.fields)
        try:
            return codec.encode(command, direction, values, variant=None if sized else index)
        except UsageError as error:
            rejection = rejection or error
        if sized:
            break
    passed = ", ".join(sorted(fields)) or "none"
    message = f"no variant of the {direction} of {command} has these fields: {passed}"
    raise rejection or UsageError("fields", sorted(fields), message=message)


def value_of(field: Field, value: Any) -> Any:
    """Return a JSON value as the codecs take it; any other value is returned unchanged."""
    if field.kind == "flag" and value in (0, 1):
        return bool(value)
    if field.kind == "bytes" and isinstance(value, str):
        with suppress(ValueError):
            return bytes.fromhex(value)
    if field.kind in ("bytes", "text"):
        return value
    if isinstance(value, list):
        return tuple(
            value_of(field, part) if field.kind == "flag" else _number(part) for part in value
        )
    return _number(value)


def _number(value: Any) -> Any:
    """Return a number of JSON, which writes one that is not finite as text."""
    if isinstance(value, list):
        return tuple(map(_number, value))
    return float(value) if value in ("nan", "inf", "-inf") else value


def plain_fields(message: DecodedMessage) -> dict[str, Any]:
    """Return the values of a message by name, as JSON values: flags and enums as integers."""
    return {name: plain(value) for name, value in message.fields.items()}
