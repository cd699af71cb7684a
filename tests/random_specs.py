"""Random protocols: every part of the spec's language, in any mixture that the checker accepts."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from hypothesis import strategies as st

import random_values
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.model import Command, Edition, Variant
from cobotwire_codegen.wire import build_frame
from random_formats import formats
from random_types import FIXED, VARYING, types
from random_variants import draw_arguments, several_variants, sharing_queries

Record = dict[str, Any]


@st.composite
def frames(draw: st.DrawFn) -> Record:
    """Draw one of the maker's three frame formats, or any other of the language."""
    check = draw(st.sampled_from(["footer", "crc16-modbus", "sum", ""]))
    frame: Record = {"header": "FE FE", "maximum_data": 240, "doc": "A frame."}
    if not check:
        record, edition = draw(formats())
        # Short replies and acknowledgements need the id.
        record |= {"replies_have_command": True}
        frame = record | {"maximum_data": 255 - edition.frame.length(0)}
    elif check == "footer":
        frame["footer"] = draw(st.sampled_from(["FA", "00", "FE"]))
        frame["length_counts"] = ["command", "data", "footer"]
    else:
        frame["check"] = check
        frame["length_counts"] = ["command", "data", "check"]
    if check and draw(st.booleans()):
        values = draw(st.lists(st.integers(0, 255), min_size=1, max_size=4, unique=True))
        frame["addresses"] = {f"A{v}": {"value": v, "doc": "An arm."} for v in values}
    return {"frame": frame, "transport": {"baudrate": 115200, "deadline_ms": 500}}


@st.composite
def commands(draw: st.DrawFn) -> Record:
    """Draw some commands; each has its own id, so that no two can be confused."""
    ids = draw(st.lists(st.integers(0, 255), min_size=1, max_size=4, unique=True))
    made: Record = {}
    for index, id in enumerate(ids):
        command = {"id": id, "title": "A call", "doc": "Does it.", "safety": "setting"}
        kind = draw(st.sampled_from(["one", "one", "varying", "several", "event"]))
        if kind == "varying":
            command |= draw(_varying())
        elif kind == "several":
            command |= draw(_several())
        elif kind == "event":
            reply = [{"name": "news", "type": draw(st.sampled_from(FIXED))}]
            command |= {"safety": "query", "event": True, "reply": reply}
        else:
            command |= draw(_one())
        made[f"call{index}"] = command
    if draw(st.integers(0, 2)) == 0:
        free = st.integers(0, 255).filter(lambda id: id not in ids)
        made |= draw(sharing_queries(draw(free), FIXED))
    for command in made.values():
        _stored(draw, command, made)
    return made


@st.composite
def _one(draw: st.DrawFn) -> Record:
    """Draw a request with a selector, a constant or an optional field, and perhaps a reply."""
    each = st.sampled_from(FIXED)
    fields: list[Record] = [
        {"name": f"f{position}", "type": draw(each)} for position in range(draw(st.integers(0, 3)))
    ]
    if draw(st.booleans()):
        cases = {str(n): {"type": draw(st.sampled_from(["q0", "q0"]))} for n in (1, 2, 3)}
        fields += [{"name": "chosen", "selector": "number", "cases": cases}]
        fields += [{"name": "number", "type": "joint"}]
    if draw(st.booleans()):
        fields.insert(0, {"name": "always", "type": "flag", "const": 1})
    if draw(st.booleans()):
        fields.append({"name": "extra", "type": draw(each), "optional": True})
    command: Record = {"request": fields} if fields else {}
    if draw(st.booleans()):
        command["safety"] = "query"
        reply: list[Record] = [{"name": "answer", "type": draw(each)}]
        if any(field == {"name": "f0", "type": "joint"} for field in fields):
            echo = draw(st.sampled_from(["required", "optional"]))
            reply.insert(0, {"name": "f0", "type": "joint", "echo": echo})
        command["reply"] = reply
    return command


@st.composite
def _several(draw: st.DrawFn) -> Record:
    """Draw several variants of a request, and perhaps of a reply."""
    command: Record = {"request_variants": draw(several_variants("request", FIXED))}
    if draw(st.booleans()):
        command["safety"] = "query"
        command["reply_variants"] = draw(several_variants("reply", FIXED))
    return command


@st.composite
def _varying(draw: st.DrawFn) -> Record:
    """Draw messages with sizes that vary: counted, to the end, or both."""
    command: Record = {}
    if draw(st.booleans()):
        command["request"] = draw(_sized_fields())
    if draw(st.booleans()) or not command:
        fields = draw(_sized_fields())
        # The last field of a query's reply is what a setting stores.
        fields[-1]["name"] = "answer"
        command |= {"safety": "query", "reply": fields}
    return command


@st.composite
def _sized_fields(draw: st.DrawFn) -> list[Record]:
    fields: list[Record] = []
    if draw(st.booleans()):
        fields.append({"name": "before", "type": draw(st.sampled_from(FIXED))})
    ways = draw(st.sampled_from(["end", "count", "both"]))
    if ways != "end":
        fields.append({"name": "size", "type": "count"})
        fields.append({"name": "data", "type": draw(st.sampled_from(VARYING)), "count": "size"})
    if ways != "count":
        fields.append({"name": "rest", "type": draw(st.sampled_from(VARYING))})
    if draw(st.booleans()):
        fields.append({"name": "after", "type": draw(st.sampled_from(FIXED))})
    return fields


@st.composite
def acks(draw: st.DrawFn) -> Record:
    """Draw how setters are acknowledged: by a byte or nothing, or with a status word."""
    if draw(st.booleans()):
        return {"field": {"name": "done", "type": "flag"}, "why": "So it is."}
    mark = {"name": "mark", "type": "tag", "const": 255}
    fields = [*([mark] if draw(st.booleans()) else []), {"name": "status", "type": "status"}]
    accepted = draw(st.sampled_from([["ACCEPTED"], ["ACCEPTED", 7], []]))
    return {"fields": fields, "why": "So it is."} | ({"accepted": accepted} if accepted else {})


def _stored(draw: st.DrawFn, command: Record, made: Record) -> None:
    """Let a query report an argument of a setting, if their types are the same."""
    plain = [f for f in command.get("request", ()) if f.keys() == {"name", "type"}]
    own = {field["type"]: field["name"] for field in plain}
    fitting = [
        name
        for name, query in made.items()
        if command["safety"] == "setting"
        and "reply" in query
        and not query.get("event")
        and query["reply"][-1].get("type") in own
    ]
    query = draw(st.sampled_from(["", *fitting]))
    if query:
        answer = made[query]["reply"][-1]
        command["effect"] = {"stores": {own[answer["type"]]: query}}
        made[query]["effect"] = {"reports": {answer["name"]: query}}


def states_of(commands: Record) -> Record:
    """Return the declaration of the state that the effects of commands name."""
    return {
        name: {"type": command["reply"][-1]["type"]}
        for name, command in commands.items()
        if "reports" in command.get("effect", ())
    }


@st.composite
def specs(draw: st.DrawFn, folder: Path, name: str = "rnd") -> tuple[Path, Edition]:
    """Draw a whole protocol as one YAML file, with a vector for each variant; return its model."""
    data: Record = {
        "edition": name,
        "class": "Rnd",
        "title": "A random protocol",
        "doc": "A random protocol.",
        "joints": 3,
        "frame": draw(frames()),
        "types": draw(types()),
        "commands": draw(commands()),
    }
    if state := states_of(data["commands"]):
        data["state"] = state
    if draw(st.booleans()):
        data["acks"] = draw(acks())
    path = folder / f"{name}.yaml"
    _write(path, data)
    draw_arguments(draw, data, build_edition(path, folder))
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


def _write(path: Path, data: Record) -> None:
    """Write a spec as JSON, which is YAML too: to write block style takes twenty times as long."""
    path.write_text(json.dumps(data))


@st.composite
def vectors(
    draw: st.DrawFn, edition: Edition, command: Command, direction: Any, variant: Variant
) -> Record:
    """Draw a vector for a variant; the generator's exact encoder builds its frame."""
    values: Record = {}
    for field in variant:
        if not field.selector:
            values[field.name] = draw(random_values.of_field(field, field.type))
    for field in variant:
        if field.selector:
            chosen = random_values.type_of(field, values)
            values[field.name] = draw(random_values.of_field(field, chosen))
    exact = random_values.counted(variant, values)
    frame = build_frame(edition.frame, command, direction, exact)
    return {
        "command": command.name,
        "direction": direction,
        "frame": frame.hex(" "),
        "values": {key: random_values.as_yaml(value) for key, value in exact.items()},
    }
