"""Convert decoded values to the types that a message declares: enums, named tuples, radians."""

from __future__ import annotations

import sys
from collections.abc import Callable, Container, Sequence
from functools import partial
from typing import Any, get_args, get_type_hints

from cobotwire.protocol.radians import to_radians


def converters_of(
    message: type, names: Sequence[str], radians: Container[str]
) -> dict[str, Callable[[Any], Any]]:
    """Return the functions that turn decoded values into what the class's annotations declare.

    Args:
        message: the class of a message.
        names: its fields.
        radians: those in radians, which the wire carries in degrees.
    """
    hints = _declared(message)
    found: dict[str, Callable[[Any], Any]] = {}
    for name in names:
        convert = _converter(hints[name])
        if name in radians:
            convert = _in_radians(convert)
        if convert is not None:
            found[name] = convert
    return found


def _declared(message: type) -> dict[str, Any]:
    """Return the types of a class's own annotations; to resolve its bases too would be slower."""

    def own() -> None:
        pass

    own.__annotations__ = message.__annotations__
    return get_type_hints(own, vars(sys.modules[message.__module__]))


def _converter(hint: Any) -> Callable[[Any], Any] | None:
    """Return the function that converts a decoded value to ``hint``; None if none is needed."""
    origin, parts = getattr(hint, "__origin__", None), get_args(hint)
    if origin is tuple or (origin is not None and origin.__name__ == "Sequence"):
        element = _converter(parts[0])
        return None if element is None else lambda values: tuple(map(element, values))
    if parts:
        every = [*filter(None, map(_converter, parts))]
        # Where variants differ in their enum, the field keeps its number.
        return every[0] if len(every) == 1 else None
    if not isinstance(hint, type):
        return None
    if issubclass(hint, tuple) and hasattr(hint, "_make"):
        inner = [_converter(each) for each in get_type_hints(hint).values()]
        if any(inner):
            return lambda row: hint(*[f(v) if f else v for f, v in zip(inner, row)])
        # As ``_make`` does, without counting the values: the codec has decoded them.
        return partial(tuple.__new__, hint)
    if hint is bool:
        return bool
    members = getattr(hint, "_value2member_map_", None)
    # Where a selector decides the type, a number may belong to another type than the enum.
    return None if members is None else lambda value: members.get(value, value)


def _in_radians(convert: Callable[[Any], Any] | None) -> Callable[[Any], Any]:
    if convert is None:
        return to_radians
    return lambda value: convert(to_radians(value))
