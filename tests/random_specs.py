"""Random protocols: every part of the spec's language, in any mixture that the checker accepts."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

from hypothesis import strategies as st
from ruamel.yaml import YAML

from cobotwire_codegen.build import build_edition
from cobotwire_codegen.language.units import UNITS
from cobotwire_codegen.model import (
    Bits,
    Chars,
    Command,
    Edition,
    Enum,
    Field,
    Flag,
    Octets,
    Quantity,
    Type,
    Value,
    Variant,
)
from cobotwire_codegen.wire import build_frame
from random_variants import constant, draw_arguments, several_variants, sharing_queries

# Scales with finite decimals as multiples, so that a vector can state them exactly.
SCALES = ["1", "1/10", "1/100", "1/1000", "1/8", "3/20", "5", "1/2"]


@st.composite
def frames(draw: st.DrawFn) -> dict[str, Any]:
    """Draw one of the maker's three frame formats."""
    check = draw(st.sampled_from(["footer", "crc16-modbus", "sum"]))
    frame: dict[str, Any] = {"header": "FE FE", "maximum_data": 240, "doc": "A frame."}
    if check == "footer":
        frame["footer"] = draw(st.sampled_from(["FA", "00", "FE"]))
        frame["length_counts"] = ["command", "data", "footer"]
    else:
        frame["check"] = check
        frame["length_counts"] = ["command", "data", "check"]
    if draw(st.booleans()):
        values = draw(st.lists(st.integers(0, 255), min_size=1, max_size=4, unique=True))
        frame["addresses"] = {f"A{v}": {"value": v, "doc": "An arm."} for v in values}
    return {"frame": frame, "transport": {"baudrate": 115200, "deadline_ms": 500}}


@st.composite
def types(draw: st.DrawFn, plain: bool) -> dict[str, Any]:
    """Draw wire types, quantities, flags, enums and values; ``plain``: none that a target lacks."""
    wires: dict[str, Any] = {
        "byte": {"bytes": 1, "doc": "A byte."},
        "double": {"bytes": 2, "doc": "Two bytes."},
    }
    for index in range(draw(st.integers(1, 3))):
        width = draw(st.integers(1, 4))
        top = 256**width - 1
        signs = st.sampled_from([top, top // 2]) | st.integers(0, top)
        order = draw(st.sampled_from(["big", "little"]))
        sign = draw(signs)
        if not plain and draw(st.integers(0, 4)) == 0:
            wires[f"w{index}"] = {
                "bytes": draw(st.sampled_from([4, 8])),
                "order": order,
                "encoding": "float",
                "doc": "A float.",
            }
            continue
        wires[f"w{index}"] = {"bytes": width, "order": order, "signed_at": sign, "doc": "A wire."}
    quantities = {f"q{index}": draw(quantity(wires)) for index in range(draw(st.integers(2, 4)))}
    names = st.sampled_from(sorted(quantities))
    members = draw(st.lists(st.integers(0, 255), min_size=1, max_size=4, unique=True))
    items = draw(st.lists(names, min_size=1, max_size=4))
    return {
        "wire": wires,
        "quantities": {
            "joint": {"wire": "byte", "range": [1, 3], "doc": "A joint."},
            "wide": {"wire": "double", "range": [1, 3], "doc": "Two bytes."},
            "tag": {"wire": "byte", "scale": "1/10", "doc": "A tag."},
            **quantities,
        },
        "flags": {"flag": {"wire": "byte", "doc": "Yes or no."}},
        "enums": {
            "mode": {
                "class": "Mode",
                "wire": "byte",
                "doc": "A mode.",
                "members": {f"M{v}": {"value": v, "doc": "A member."} for v in members},
            }
        },
        "values": {
            "row": {
                "class": "Row",
                "doc": "A row.",
                "items": {f"i{index}": name for index, name in enumerate(items)},
            }
        },
    }


@st.composite
def quantity(draw: st.DrawFn, wires: dict[str, Any]) -> dict[str, Any]:
    """Draw a quantity on one of the wire types, with or without a range or choices."""
    name = draw(st.sampled_from(sorted(wires)))
    wire = wires[name]
    if wire.get("encoding") == "float":
        return draw(real_quantity(name))
    top = 256 ** wire["bytes"] - 1
    signed_at = wire.get("signed_at", top)
    lowest = 0 if signed_at == top else signed_at + 1 - 256 ** wire["bytes"]
    made: dict[str, Any] = {"wire": name, "doc": "A quantity."}
    steps = st.integers(lowest, signed_at)
    if draw(st.integers(0, 3)) == 0:
        made["choices"] = draw(st.lists(steps, min_size=1, max_size=4, unique=True))
        return made
    scale = draw(st.sampled_from(SCALES))
    made |= {"scale": scale, "unit": draw(st.sampled_from(sorted(UNITS)))}
    if draw(st.booleans()):
        ends = sorted([draw(steps), draw(steps)])
        made["range"] = [decimal(end * Fraction(scale)) for end in ends]
    return made


@st.composite
def real_quantity(draw: st.DrawFn, wire: str) -> dict[str, Any]:
    """Draw a quantity that is a float, with or without a range."""
    made: dict[str, Any] = {"wire": wire, "unit": draw(st.sampled_from(sorted(UNITS))), "doc": "Q."}
    kind = draw(st.integers(0, 2))
    if kind == 0:
        made["range"] = sorted([draw(st.integers(-1000, 0)), draw(st.integers(0, 1000))])
    elif kind == 1:
        made["not_finite"] = True
    return made


def decimal(exact: Fraction) -> Any:
    """Return a number that YAML represents exactly."""
    if exact.denominator == 1:
        return int(exact)
    return float(Decimal(exact.numerator) / Decimal(exact.denominator))


@st.composite
def commands(draw: st.DrawFn) -> dict[str, Any]:
    """Draw some commands; each has its own id, so that no two can be confused."""
    kinds = st.sampled_from(["joint", "q0", "q1", "flag", "mode", "row"])
    ids = draw(st.lists(st.integers(0, 255), min_size=1, max_size=4, unique=True))
    made: dict[str, Any] = {}
    for index, id in enumerate(ids):
        fields: list[dict[str, Any]] = [
            {"name": f"f{position}", "type": draw(kinds)}
            for position in range(draw(st.integers(0, 3)))
        ]
        if draw(st.booleans()):
            cases = {str(n): {"type": draw(st.sampled_from(["q0", "q0"]))} for n in (1, 2, 3)}
            fields += [{"name": "chosen", "selector": "number", "cases": cases}]
            fields += [{"name": "number", "type": "joint"}]
        if draw(st.booleans()):
            fields.insert(0, {"name": "always", "type": "flag", "const": 1})
        if draw(st.booleans()):
            fields.append({"name": "extra", "type": draw(kinds), "optional": True})
        command = {"id": id, "title": "A call", "doc": "Does it.", "safety": "setting"}
        if fields:
            command["request"] = fields
        if draw(st.booleans()):
            command["safety"] = "query"
            reply: list[dict[str, Any]] = [{"name": "answer", "type": draw(kinds)}]
            if any(field == {"name": "f0", "type": "joint"} for field in fields):
                echo = draw(st.sampled_from(["required", "optional"]))
                reply.insert(0, {"name": "f0", "type": "joint", "echo": echo})
            command["reply"] = reply
        if draw(st.booleans()):
            command.pop("request", None)
            command["request_variants"] = draw(several_variants("request"))
            if "reply" in command:
                command.pop("reply")
                command["reply_variants"] = draw(several_variants("reply"))
        made[f"call{index}"] = command
    if draw(st.integers(0, 2)) == 0:
        free = st.integers(0, 255).filter(lambda id: id not in ids)
        made |= draw(sharing_queries(draw(free)))
    for command in made.values():
        _read_by(draw, command, made)
    return made


def _read_by(draw: st.DrawFn, command: dict[str, Any], made: dict[str, Any]) -> None:
    """Let a query report an argument of a setting, if their types are the same."""
    plain = [f for f in command.get("request", ()) if f.keys() == {"name", "type"}]
    own = {field["type"]: field["name"] for field in plain}
    fitting = [
        name
        for name, query in made.items()
        if command["safety"] == "setting"
        and "reply" in query
        and query["reply"][-1].get("type") in own
    ]
    query = draw(st.sampled_from(["", *fitting]))
    if query:
        command["read_by"] = {query: {"answer": own[made[query]["reply"][-1]["type"]]}}


@st.composite
def specs(
    draw: st.DrawFn, folder: Path, name: str = "rnd", *, plain: bool = False
) -> tuple[Path, Edition]:
    """Draw a whole protocol as one YAML file, with a vector for each variant; return its model.

    ``plain`` leaves out the types that some output targets cannot express.
    """
    data: dict[str, Any] = {
        "edition": name,
        "class": "Rnd",
        "title": "A random protocol",
        "doc": "A random protocol.",
        "joints": 3,
        "frame": draw(frames()),
        "types": draw(types(plain)),
        "commands": draw(commands()),
    }
    path = folder / f"{name}.yaml"
    _write(path, data)
    draw_arguments(draw, data, build_edition(path, folder), _text_of)
    _write(path, data)
    edition = build_edition(path, folder)
    data["vectors"] = [
        {**vector, "name": f"{command.name} {direction} {index}"}
        for command in edition.commands
        for direction in ("request", "reply")
        for index, variant in enumerate(command.variants(direction))
        for vector in [draw(vectors(edition, command, direction, variant))]
    ]
    _write(path, data)
    return path, build_edition(path, folder)


def _write(path: Path, data: dict[str, Any]) -> None:
    yaml = YAML()
    yaml.width = 4096
    with path.open("w") as file:
        yaml.dump(data, file)


@st.composite
def vectors(
    draw: st.DrawFn, edition: Edition, command: Command, direction: Any, variant: Variant
) -> dict[str, Any]:
    """Draw a vector for a variant; the generator's exact encoder builds its frame."""
    values: dict[str, Any] = {}
    for field in variant:
        if not field.selector:
            values[field.name] = draw(_value(field, field.type))
    for field in variant:
        if field.selector:
            cases = {member.name: type for member, type in field.cases}
            values[field.name] = draw(_value(field, cases[str(values[field.selector])]))
    exact = {field.name: values[field.name] for field in variant}
    frame = build_frame(edition.frame, command, direction, exact)
    return {
        "command": command.name,
        "direction": direction,
        "frame": frame.hex(" "),
        "values": {key: _as_text(value) for key, value in exact.items()},
    }


def _value(field: Field, type: Type) -> st.SearchStrategy[Any]:
    if field.const is not None:
        return st.just(constant(field, type))
    return _of_type(type)


def _of_type(type: Type) -> st.SearchStrategy[Any]:
    if isinstance(type, Flag):
        return st.booleans()
    if isinstance(type, Enum):
        return st.sampled_from([member.name for member in type.members])
    if isinstance(type, Quantity):
        return _number(type)
    if isinstance(type, Value):
        return st.tuples(*(_number(item) for _, item in type.items))
    return _shaped(type)


def _shaped(type: Any) -> st.SearchStrategy[Any]:
    """Draw bits, bytes, a text or a list."""
    if isinstance(type, Bits):
        return st.tuples(*(_of_type(part) for _, part in type.items))
    least, most = type.sizes
    if isinstance(type, Octets):
        return st.binary(min_size=least, max_size=most).map(lambda data: data.hex(" "))
    if isinstance(type, Chars):
        short = least if type.padding is None else 0
        return st.text(st.sampled_from("abc "), min_size=short, max_size=most).map(
            lambda text: text.replace(" ", "x")
        )
    elements = st.lists(_of_type(type.of), min_size=least, max_size=most)
    return elements.map(tuple)


def _text_of(field: Field, type: Type) -> st.SearchStrategy[Any]:
    return _value(field, type).map(_as_text)


def _number(type: Quantity) -> st.SearchStrategy[Fraction]:
    if type.choices:
        return st.sampled_from(type.choices).map(Fraction)
    if type.wire.is_float:
        # Quarters are floats of both widths, and decimals that YAML represents exactly.
        low, high = (int(end) for end in type.ends)
        return st.integers(max(4 * low, -40_000), min(4 * high, 40_000)).map(
            lambda quarters: Fraction(quarters, 4)
        )
    lowest, highest = (int(bound) for bound in type.bounds)
    return st.integers(lowest, highest).map(lambda steps: steps * type.scale)


def _as_text(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_as_text(item) for item in value]
    return decimal(value) if isinstance(value, Fraction) else value
