"""Compare the declarations for construct, run by that library, with codecs and vectors."""

from __future__ import annotations

import runpy
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

from construct import Array, Bytes, Const, ConstructError, Struct, Switch

from targets.built import built
from targets.comparison import Comparison
from targets.vectors.comparison import Record, read
from vectors import edition as edition_of

Key = tuple[str, str, int]


@lru_cache
def messages(edition: str) -> dict[Key, Any]:
    """Return the declarations of an edition's module, by command, direction and variant."""
    found: dict[Key, Any] = runpy.run_path(str(built("construct") / f"{edition}.py"))["MESSAGES"]
    return found


def compare(edition: str, declared: dict[Key, Any] | None = None) -> Comparison:
    """Compare every vector of an edition, with the given declarations or the generated ones."""
    return judged(read(edition), declared or messages(edition))


def judged(document: Record, declared: dict[Key, Any]) -> Comparison:
    """Compare the vectors of a document with the declarations."""
    differences, id_at = [], edition_of(document["edition"]).frame.offset("command")
    for record in document["messages"]:
        declaration = declared[record["command"], record["direction"], record["variant"]]
        differences += [f"{record['name']}: {text}" for text in _message(record, declaration)]
    for record in document["malformed"]:
        differences += [f"{record['name']}: {text}" for text in _malformed(record, declared, id_at)]
    fields = sum(len(f["raw"]) for record in document["messages"] for f in record["fields"])
    count = len(document["messages"]) + len(document["malformed"])
    return Comparison(count, fields, differences, len(document["malformed"]))


def numbers(value: Any) -> list[Any]:
    """Return what construct read in a field, as a list of numbers."""
    if isinstance(value, bytes | list):
        return list(value)
    if isinstance(value, dict):
        return [part for name, part in value.items() if name != "_io"]
    return [int(value) if isinstance(value, str | bool) else value]


def as_built_from(record: Record) -> dict[str, Any]:
    """Return a vector's values as construct takes them to build a frame."""
    return {field["name"]: field["value"] for field in record["fields"]}


def frame_built(declaration: Any, values: dict[str, list[Any]]) -> bytes:
    """Return the frame that construct builds from these values."""
    given: dict[str, Any] = {}
    for part in declaration.subcons:
        name = part.name.removesuffix("_ahead")
        # Constants are built without a value.
        if name in values and not isinstance(part.subcon, Const):
            given[part.name] = _as_declared(part.subcon, values[name], values)
    data: bytes = declaration.build(given)
    return data


def _as_declared(declared: Any, numbers: list[Any], values: dict[str, list[Any]]) -> Any:
    if isinstance(declared, Switch):
        context = {f"{name}{end}": n[0] for name, n in values.items() for end in ("", "_ahead")}
        declared = declared.cases[declared.keyfunc(context)]
    if isinstance(declared, Bytes):
        return bytes(numbers)
    if isinstance(declared, Array):
        return [_as_declared(declared.subcon, [number], values) for number in numbers]
    if isinstance(declared, Struct):
        return dict(zip((item.name for item in declared.subcons), numbers, strict=True))
    return numbers[0]


def _message(record: Record, declaration: Any) -> Iterator[str]:
    data = bytes.fromhex(record["bytes"])
    try:
        parsed = declaration.parse(data)
        again = frame_built(declaration, as_built_from(record))
    except ConstructError as error:
        yield f"rejected: {error}"
        return
    for name, right in as_built_from(record).items():
        if numbers(parsed[name]) != right:
            yield f"{name} reads {numbers(parsed[name])}, not {right}"
    if again != data:
        yield f"built {again.hex(' ')}"


def _malformed(record: Record, declared: dict[Key, Any], id_at: int) -> Iterator[str]:
    """Yield every message of that direction that accepts malformed bytes."""
    data = bytes.fromhex(record["bytes"])
    for (command, direction, variant), declaration in declared.items():
        # The others reject the id, which each of them declares as a constant.
        if direction == record["direction"] and data[id_at : id_at + 1] in (b"", _id(declaration)):
            try:
                declaration.parse(data)
            except ConstructError:
                continue
            yield f"accepted as variant {variant} of {command}"


def _id(declaration: Any) -> bytes:
    id: int = next(part for part in declaration.subcons if part.name == "frame_id").subcon.value
    return bytes([id])
