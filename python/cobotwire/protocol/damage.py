"""Say where an ``edition.json`` is damaged."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from typing import Any

# The JSON type of each value, by its key, wherever it stands. Keys that are not here have numbers,
# which are integers or texts such as "1/100".
_KEYS: tuple[tuple[type, str], ...] = (
    (
        str,
        "alias argument base check check_from check_order class_name doc document echo family"
        " field firmware footer format generated geometry_unknown header kind name of order"
        " place query role replies safety says selector suffix title unit wire",
    ),
    (
        int,
        "acceleration baudrate bits check_width closed const deadline_ms divide fastest first"
        " highest id init initial joints last least maximum maximum_data maximum_length minimum"
        " most multiply no_power no_solution no_straight_line open poly shift signed_at"
        " silence_ms stopped ticks value version width xorout zero",
    ),
    (
        list,
        "accepted addresses agrees_with arguments bases cases choices commands default families"
        " fields items joint_limits labels links meanings members notes numbers prefixes"
        " registers reply request samples shares_id signs types values when wires",
    ),
    (
        dict,
        "address_range crc edition effect encoders error_codes firmware_versions frame geometry"
        " motion read_by request_text servos state text",
    ),
    (bool, "ack event more optional radians refin refout replies_without_id"),
)
KINDS = {key: kind for kind, keys in _KEYS for key in keys.split()}
NAMES_OF_JSON = {dict: "an object", list: "a list", str: "a text", int: "an integer"}
NAMES_OF_JSON |= {bool: "true or false", float: "a number", type(None): "null"}


def damage_of(data: bytes, read: Callable[[Any], object]) -> str:
    """Return what is wrong with the bytes of an ``edition.json``, and at which JSON path.

    ``read`` makes a table of the document, which finds missing keys.
    """
    try:
        document = json.loads(data.decode())
    except UnicodeDecodeError as error:
        return f"it is not UTF-8 text: byte {error.start} is {data[error.start]:#04x}"
    except json.JSONDecodeError as error:
        return f"it is not JSON: {error.msg} in line {error.lineno}, column {error.colno}"
    except RecursionError:
        return "it is not JSON of an edition: it is nested too deeply"
    except ValueError as error:
        return f"it is not JSON of an edition: {error}"
    if not isinstance(document, dict):
        return f"$ is {NAMES_OF_JSON[type(document)]}; allowed: an object"
    found = next(_wrong_types(document, "$"), "")
    if found:
        return found
    visited = ["$"]
    try:
        read(_traced(document, "$", visited))
    except _Missing as missing:
        return f"{missing} is missing"
    except Exception as error:  # any: the value can be wrong in any way
        return f"{visited[-1]} cannot be read: {type(error).__name__}: {error}"
    return "it is not as cobotwire-gen wrote it, although every value has a legal type"


class _Missing(Exception):
    """A key that the document must have; the text is its path."""


class _Traced(dict[str, Any]):
    """An object that notes which of its keys was read last."""

    def __init__(self, items: dict[str, Any], path: str, visited: list[str]) -> None:
        super().__init__(items)
        self._path, self._visited = path, visited

    def __getitem__(self, key: str) -> Any:
        self._visited.append(f"{self._path}.{key}")
        return super().__getitem__(key)

    def get(self, key: str, default: Any = None) -> Any:
        if key not in self:
            return default
        return self[key]

    def __missing__(self, key: str) -> Any:
        raise _Missing(f"{self._path}.{key}")


def _traced(value: Any, path: str, visited: list[str]) -> Any:
    if isinstance(value, list):
        return [_traced(each, f"{path}[{n}]", visited) for n, each in enumerate(value)]
    if isinstance(value, dict):
        items = {key: _traced(each, f"{path}.{key}", visited) for key, each in value.items()}
        return _Traced(items, path, visited)
    return value


def _wrong_types(value: Any, path: str) -> Iterator[str]:
    """Yield the values that have another JSON type than their key says."""
    if isinstance(value, list):
        for number, each in enumerate(value):
            yield from _wrong_types(each, f"{path}[{number}]")
    elif isinstance(value, dict):
        for key, each in value.items():
            here = f"{path}.{key}"
            # In these two, the keys are names of states and fields, or the verb of an effect.
            named = ".state." in here or ".effect." in here
            kind = object if named else KINDS.get(key, object)
            if not isinstance(each, kind) or (kind is int and isinstance(each, bool)):
                yield f"{here} is {NAMES_OF_JSON[type(each)]}; allowed: {NAMES_OF_JSON[kind]}"
            yield from _wrong_types(each, here)
