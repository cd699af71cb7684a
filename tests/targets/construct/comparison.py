"""The declarations for construct, read by that library, beside our codecs and the vectors."""

from __future__ import annotations

import runpy
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

from construct import ConstructError

from targets.comparison import Comparison
from targets.vectors.comparison import Record, read
from vectors import ROOT

FOLDER = ROOT / "targets" / "construct"
Key = tuple[str, str, int]


@lru_cache
def messages(edition: str) -> dict[Key, Any]:
    """The declarations of an edition's module, by command, direction and form."""
    found: dict[Key, Any] = runpy.run_path(str(FOLDER / f"{edition}.py"))["MESSAGES"]
    return found


def compare(edition: str, declared: dict[Key, Any] | None = None) -> Comparison:
    """Every vector of an edition; by other declarations than ours, where there are any."""
    document, declared = read(edition), declared or messages(edition)
    differences = []
    for record in document["messages"]:
        declaration = declared[record["command"], record["direction"], record["form"]]
        differences += [f"{record['name']}: {text}" for text in _message(record, declaration)]
    for record in document["malformed"]:
        differences += [f"{record['name']}: {text}" for text in _malformed(record, declared)]
    fields = sum(len(f["whole"]) for record in document["messages"] for f in record["fields"])
    count = len(document["messages"]) + len(document["malformed"])
    return Comparison(count, fields, differences)


def numbers(value: Any) -> list[Any]:
    """What construct read in a field, as a list of numbers."""
    if isinstance(value, dict):
        return [part for name, part in value.items() if name != "_io"]
    return [int(value) if isinstance(value, str | bool) else value]


def said(record: Record) -> dict[str, Any]:
    """A vector's values as construct builds from them."""
    return {field["name"]: field["value"] for field in record["fields"]}


def built(declaration: Any, values: dict[str, list[Any]]) -> bytes:
    """The frame that construct makes of these values."""
    given: dict[str, Any] = {}
    for part in declaration.subcons:
        name = part.name.removesuffix("_ahead")
        if name in values:
            given[part.name] = _as_declared(part, values[name], values)
    data: bytes = declaration.build(given)
    return data


def _as_declared(part: Any, numbers: list[Any], values: dict[str, list[Any]]) -> Any:
    if len(numbers) == 1:
        return numbers[0]
    inner = part.subcon
    if hasattr(inner, "cases"):
        inner = inner.cases[next(int(n[0]) for name, n in values.items() if name == "kind")]
    return dict(zip((item.name for item in inner.subcons), numbers))


def _message(record: Record, declaration: Any) -> Iterator[str]:
    data = bytes.fromhex(record["bytes"])
    try:
        parsed = declaration.parse(data)
        again = built(declaration, said(record))
    except ConstructError as error:
        yield f"refused: {error}"
        return
    for name, right in said(record).items():
        if numbers(parsed[name]) != right:
            yield f"{name} reads {numbers(parsed[name])}, not {right}"
    if again != data:
        yield f"built {again.hex(' ')}"


def _malformed(record: Record, declared: dict[Key, Any]) -> Iterator[str]:
    """No message of that direction may take what is malformed."""
    data = bytes.fromhex(record["bytes"])
    for (command, direction, form), declaration in declared.items():
        # The others refuse the id, which each of them says as a constant.
        if direction == record["direction"] and data[3:4] in (b"", _id(declaration)):
            try:
                declaration.parse(data)
            except ConstructError:
                continue
            yield f"taken for form {form} of {command}"


def _id(declaration: Any) -> bytes:
    id: int = next(part for part in declaration.subcons if part.name == "frame_id").subcon.value
    return bytes([id])
