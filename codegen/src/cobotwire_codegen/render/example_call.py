"""Writes the example at the top of a command's reference: a call in Python, and what it returns."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from fractions import Fraction

from cobotwire_codegen.model import Command, Edition, Enum, Octets, Quantity, Type, Value
from cobotwire_codegen.model.shapes import Bits, Listed
from cobotwire_codegen.render.arguments import arguments
from cobotwire_codegen.render.examples import examples
from cobotwire_codegen.render.markdown import text_vector
from cobotwire_codegen.render.parameters import Parameter, parameters, results, returns
from cobotwire_codegen.render.words import decimal

# Other texts need escapes, which are hard to read, so ``...`` replaces them.
_PLAIN = re.compile(r"[\w .,:/-]*\Z", re.ASCII)
_ANY_TEXT = '"..."'


def example_call(edition: Edition, command: Command) -> str:
    """Return a call with the values of the request's example; empty if it has none."""
    vector = examples(edition, command).get("request")
    if vector is None or command.event:
        return ""
    values = dict(vector.values)
    fields = {parameter.name: parameter for parameter in parameters(command)}
    given = []
    for argument in arguments(command):
        if argument.name in values and argument.name in fields:
            value = _argument(fields[argument.name], values[argument.name])
            given.append(f"{argument.name}={value}")
        elif argument.name not in fields:
            given.append(f"{argument.name}={_text(values.get(argument.name))}")
    return f"arm.{command.name}({', '.join(given)})"


def example_result(edition: Edition, command: Command) -> str:
    """Return what a call returns, with the values of the reply's example; empty if it has none."""
    if command.text is not None:
        return _text_result(edition, command)
    found = results(command)
    vector = examples(edition, command).get("reply")
    if not found or vector is None:
        return ""
    values = dict(vector.values)
    shown = [_result(p, values[p.name]) if p.name in values else "None" for p in found]
    if len(found) == 1:
        return shown[0]
    pairs = (f"{parameter.name}={value}" for parameter, value in zip(found, shown))
    return f"{returns(command)}({', '.join(pairs)})"


def _text_result(edition: Edition, command: Command) -> str:
    vector = text_vector(edition, command)
    values: Mapping[str, object] = dict(vector.values) if vector else {}
    names = [name for name, _ in command.text.fields] if command.text else []
    pairs = (f"{name}={_text(values.get(name))}" for name in names)
    return f"{returns(command)}({', '.join(pairs)})"


def _text(value: object) -> str:
    return f'"{value}"' if isinstance(value, str) and _PLAIN.match(value) else _ANY_TEXT


def _argument(parameter: Parameter, value: object) -> str:
    type = _fitting(parameter, value)
    if isinstance(type, Listed) and isinstance(value, tuple):
        return f"[{', '.join(_item(type.of, item) for item in value)}]"
    return _item(type, value)


def _item(type: Type, value: object) -> str:
    if isinstance(value, tuple):
        numbers = (_number(part, each) for (_, part), each in zip(_parts(type), value))
        return f"[{', '.join(numbers)}]"
    if isinstance(type, Enum):
        return f"{type.class_name}.{value}"
    if isinstance(value, str):
        # The codecs take bytes where a spec writes hex digits.
        return f'bytes.fromhex("{value}")' if isinstance(type, Octets) else _text(value)
    return _number(type, value)


def _parts(type: Type) -> Iterator[tuple[str, Type]]:
    yield from type.items if isinstance(type, Value | Bits) else ()


def _number(type: Type, value: object) -> str:
    if isinstance(type, Enum) and isinstance(value, str):
        return f"{type.class_name}.{value}"
    if isinstance(value, bool) or not isinstance(value, int | Fraction):
        return str(value)
    if isinstance(type, Quantity) and type.radians:
        return f"{math.radians(value):.5g}"
    return decimal(Fraction(value))


def _result(parameter: Parameter, value: object) -> str:
    type = _fitting(parameter, value)
    if isinstance(value, tuple) and isinstance(type, Value) and len(parameter.types) > 1:
        # No class fits all types of the parameter, so the call returns a plain tuple.
        return f"({', '.join(_real(part, each) for (_, part), each in zip(_parts(type), value))})"
    if isinstance(type, Listed) and isinstance(value, tuple):
        items = [_returned(type.of, item) for item in value]
        return f"({', '.join(items)}{',' * (len(items) == 1)})"
    return _returned(type, value)


def _returned(type: Type, value: object) -> str:
    if isinstance(value, tuple):
        pairs = zip(_parts(type), value)
        parts = ", ".join(f"{name}={_real(part, each)}" for (name, part), each in pairs)
        return f"{type.class_name}({parts})"
    if isinstance(value, str) and isinstance(type, Octets):
        return f'bytes.fromhex("{value}")'
    if isinstance(value, str) and not isinstance(type, Enum):
        return _text(value)
    return _real(type, value)


def _real(type: Type, value: object) -> str:
    """Return a number as Python shows a result: a quantity with a scale is a float."""
    shown = _number(type, value)
    real = isinstance(type, Quantity) and type.real and not isinstance(value, bool)
    return f"{shown}.0" if real and re.fullmatch(r"-?\d+", shown) else shown


def _fitting(parameter: Parameter, value: object) -> Type:
    """Return the type of the parameter that matches a value; the first type if none does."""
    size = len(value) if isinstance(value, tuple) else None
    for type in parameter.types:
        parts = len(list(_parts(type))) or None
        if isinstance(type, Listed) or parts == size:
            return type
    return parameter.types[0]
