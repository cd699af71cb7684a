"""Writes the vectors of an edition as one JSON document, one line each."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from cobotwire_codegen.model import Edition, Enum, Text
from cobotwire_codegen.targets.vectors.law import Direction, Law, Reading, Span
from cobotwire_codegen.targets.vectors.malformed import malformed
from cobotwire_codegen.targets.vectors.messages import Beyond, Example, beyond, examples
from cobotwire_codegen.targets.vectors.slots import slots, texts
from cobotwire_codegen.targets.vectors.streams import streams

VERSION = 1


def document(edition: Edition) -> str:
    """Return the file's text."""
    laws: dict[Direction, Law] = {
        "request": Law(edition, "request"),
        "reply": Law(edition, "reply"),
    }
    found = list(examples(edition))
    ordinary = [example for example in found if example.what.startswith("ordinary")]
    head = {
        "format": "cobotwire-vectors",
        "version": VERSION,
        "generated": "by cobotwire-gen from spec/; not to be edited",
        "edition": edition.name,
        "frame": _frame(edition),
    }
    parts = {
        "messages": [_message(example, laws) for example in found],
        "rejected": [
            _rejected(case)
            for each in ordinary
            for case in beyond(edition, each)
            # Texts have no numeric range to exceed, and encoders compute element counts themselves.
            if not case.letter and not case.field.counts
        ],
        "malformed": [
            {
                "name": case.what,
                "direction": case.direction,
                "bytes": _hex(case.data),
                "reason": case.fault.reason,
                "offset": case.fault.offset,
            }
            for case in malformed(edition, laws, found)
        ],
        "streams": [
            {
                "name": stream.what,
                "direction": stream.direction,
                "bytes": _hex(stream.data),
                "events": [_span(span) for span in stream.spans],
            }
            for stream in streams(edition, laws, ordinary)
        ],
        "texts": _texts(edition),
    }
    lines = [f" {_json(key)}: {_json(value)}" for key, value in head.items()]
    lines += [f" {_json(key)}: {_list(value)}" for key, value in parts.items()]
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _frame(edition: Edition) -> dict[str, Any]:
    frame = edition.frame
    record: dict[str, Any] = {
        "header": _hex(frame.header),
        "check": frame.check_word,
        "footer": _hex(frame.footer),
        "addresses": list(frame.address_values),
    }
    if not frame.usual:
        numbers = {"length": frame.length_number, "command": frame.command_number}
        record["layout"] = [
            [part, numbers[part].width, numbers[part].order] if part in numbers else [part]
            for part in frame.layout
        ]
        record["counted"] = list(frame.counted)
        record["replies_have_command"] = frame.replies_have_command
        if frame.check is not None:
            record["check_from"] = frame.check.covers_from
            record["check_bytes"] = [frame.check.width, frame.check.order]
            record["crc"] = frame.check.crc and frame.check.crc._asdict()
    return record


def _message(example: Example, laws: dict[Direction, Law]) -> dict[str, Any]:
    reading = laws[example.direction].read(example.data)
    assert isinstance(reading, Reading), "an example is legal"
    return {
        "name": f"{example.command.name} {example.direction}, {example.what}",
        "command": example.command.name,
        "direction": example.direction,
        "variant": example.number,
        "bytes": _hex(example.data),
        "fields": _fields(example),
        # Commands may share an id: the bytes alone decode as the first command that fits.
        "read_as": reading.command.name,
    }


def _fields(example: Example) -> list[dict[str, Any]]:
    found = []
    for field in example.variant:
        numbers = example.raw_values[field.name]
        parts = slots(field, example.variant, example.raw_values) or ()
        record = {
            "name": field.name,
            "raw": list(numbers),
            "value": [slot.value(raw) for slot, raw in zip(parts, numbers)],
        }
        if isinstance(field.type, Enum) and field.const is None:
            record["label"] = next(m.name for m in field.type.members if m.value == numbers[0])
        text = texts(field, numbers)
        if text is not None:
            record["text"] = text
        found.append(record)
    return found


def _rejected(case: Beyond) -> dict[str, Any]:
    """Return a message that encoders must reject: one of its numbers is out of range."""
    example = case.example
    fields = _fields(example)
    record = next(record for record in fields if record["name"] == case.field.name)
    slot = (slots(case.field, example.variant, example.raw_values) or ())[case.element]
    record["raw"][case.element] = case.raw
    record["value"][case.element] = slot.value(case.raw)
    record.pop("label", None)
    return {
        "name": f"{example.command.name} {example.direction}, {case.field.name} {case.raw}",
        "command": example.command.name,
        "direction": example.direction,
        "variant": example.number,
        "fields": fields,
        "field": case.field.name,
        "element": case.element,
    }


def _span(span: Span) -> dict[str, Any]:
    place = {"offset": span.offset, "size": span.size}
    return place | ({"noise": span.reason} if span.id is None else {"frame": span.id})


def _texts(edition: Edition) -> list[dict[str, Any]]:
    """Return the texts outside frames: replies, and texts that follow a request."""
    found = []
    for command in edition.commands:
        for direction, text in (("request", command.request_text), ("reply", command.text)):
            if text is not None:
                found.append(_text(command.name, direction, text))
    return found


def _text(command: str, direction: str, text: Text) -> dict[str, Any]:
    values = {name: f"{name}-1" for name, _ in text.fields}
    content = "".join(prefix + value for prefix, value in zip(text.prefixes, values.values()))
    return {
        "command": command,
        "direction": direction,
        "bytes": _hex((content + text.suffix).encode()),
        "fields": values,
    }


def _list(records: Iterable[Any]) -> str:
    lines = ",\n".join(f"  {_json(record)}" for record in records)
    return f"[\n{lines}\n ]" if lines else "[]"


def _json(value: Any) -> str:
    return json.dumps(value, allow_nan=False)


def _hex(data: bytes) -> str:
    return data.hex(" ").upper()
