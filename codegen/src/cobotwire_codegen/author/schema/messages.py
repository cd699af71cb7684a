"""The frame, and the commands with their messages."""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire_codegen.author.schema.leaves import (
    CLASS,
    LOWER,
    METHOD,
    UPPER,
    Schema,
    by_key,
    closed,
    either,
    hexed,
    listed,
    name,
    named,
    one_of,
    range_of,
    ref,
    text,
    whole,
    words,
    yes,
)
from cobotwire_codegen.author.schema.types import SOURCE, free_doc, known
from cobotwire_codegen.model import CHECKS, ROLES, SAFETY

_SAFETY_DOCS = (
    "Asks and changes nothing: the only class that is repeated by itself.",
    "Changes a setting until the power goes.",
    "Moves the arm, or lets it move.",
    "Switches power.",
    "Changes what outlives a power cycle.",
)
_REFUSED_TWICE = [{"not": {"required": [key, f"{key}_forms"]}} for key in ("request", "reply")]


def frame_definitions() -> dict[str, Schema]:
    """The frame and the link."""
    counted = {"enum": ["command", "data", "footer", "check"]}
    frame = closed(
        "The frame: header, address where there are some, LEN, CMD, data, footer or check.",
        {
            "header": hexed("The two bytes that start a frame."),
            "length_counts": {**listed(counted, "What LEN counts."), "minItems": 3, "maxItems": 3},
            "maximum_data": whole("The most data bytes of a message.", 0, 253),
            "doc": text("What a reader of the frame should know."),
        },
        {
            "footer": hexed("The byte that ends a frame, where it is the check."),
            "check": one_of(CHECKS, "What tells a damaged frame. Left out: footer."),
            "addresses": named(ref("address"), "An address byte before LEN.", LOWER_OR_UPPER),
            "source": SOURCE,
        },
    )
    return {
        "frame_file": closed("The frame and the link.", {"frame": frame}, {"link": ref("link")}),
        "link": _link(),
        "address": closed(
            "An address.", {"value": whole("The byte.", 0, 255), "doc": text("Whose it is.")}
        ),
    }


LOWER_OR_UPPER = f"{LOWER}|{UPPER}"


def _link() -> Schema:
    return closed(
        "The serial link.",
        {
            "baudrate": whole("Bits a second.", 1),
            "deadline_ms": whole("How long an answer is awaited, in milliseconds.", 1),
        },
        {
            "data_bits": whole("Data bits."),
            "stop_bits": whole("Stop bits."),
            "parity": one_of(("none", "even", "odd"), "The parity bit. Left out: none."),
            "source": SOURCE,
        },
    )


def message_definitions(types: Sequence[str], docs: Sequence[str]) -> dict[str, Schema]:
    """Commands, fields and texts. ``types`` are what a field can be, ``docs`` what they are."""
    where = ref("type_name")
    found = {
        "type_name": known(types, "A quantity, flag, enum or value of the types file.", docs),
        "commands": named(ref("command"), "Commands by the name of their method.", METHOD),
        "commands_file": _family(),
        "command": command(),
        "case": closed("The type for one value of the deciding field.", {"is": where}),
        "reply_text": _text({"class": name("The class of what it says.", CLASS)}),
        "request_text": _text({}),
        "text_field": closed(
            "A part of the text.", {"name": name("Its name."), "doc": text("What it is.")}
        ),
    }
    for direction in ("request", "reply"):
        plain, selected = f"{direction}_field", f"selected_{direction}_field"
        found[f"plain_{plain}"] = plain_field(where, direction)
        found[selected] = selected_field(direction)
        found[plain] = by_key([("by", ref(selected))], ref(f"plain_{plain}"))
    return found


def _family() -> Schema:
    return closed(
        "A family of commands.",
        {
            "family": name("The family's name: a module of the generated Python."),
            "title": text("A heading."),
            "doc": text("What belongs into it."),
            "commands": ref("commands"),
        },
    )


def command() -> Schema:
    """One command."""
    required = {
        "id": whole("CMD, the byte that tells the command.", 0, 255),
        "title": text("A heading."),
        "doc": text("One or two sentences on what it does."),
        "safety": one_of(SAFETY, "What may be repeated, and what a test may send.", _SAFETY_DOCS),
    }
    optional = {
        "source": SOURCE,
        **_messages("request", "What is sent. Left out: no data."),
        **_messages("reply", "What answers. Left out: nothing."),
        "reply_text": ref("reply_text"),
        "request_text": ref("request_text"),
        "ack": yes("The reply is an acknowledgement: it may come, late or never."),
        "alias": name("The command whose message this is, under a name of its own.", METHOD),
        "role": one_of(
            ROLES, "What hand-written code knows it by: targets, what tells of them, stop."
        ),
        "read_by": read_by(),
        "agrees_with": words("Queries that tell the same while the arm rests."),
        "tries": listed(
            named(listed(whole("A number."), "What may be sent.", 1), "Numbers by argument."),
            "What a conformance run may send, where not every legal number is harmless.",
        ),
        "shares_id": words("Calls with the same id and other data."),
        "deadline_ms": whole("How long an answer is awaited. Left out: as the link says.", 1),
        "notes": listed({"type": "string"}, "Sentences for the reference."),
        "disputed": ref("disputed"),
    }
    return {**closed("One call.", required, optional), "allOf": _REFUSED_TWICE}


def read_by() -> Schema:
    """The query that tells what the command has set."""
    said = named({"type": ["string", "integer"]}, "A reply's field: the argument or the number.")
    query = {"type": "object", "additionalProperties": said, "minProperties": 1, "maxProperties": 1}
    doc = "The query that tells what it has set; with the fields, where their names differ."
    return {**either("object", query, {"type": "string"}), "description": doc}


def _messages(key: str, doc: str) -> dict[str, Schema]:
    form = listed(ref(f"{key}_field"), "A form: its fields in order.")
    return {
        key: listed(ref(f"{key}_field"), doc, 1),
        f"{key}_forms": listed(form, f"The forms of the {key}, the full one first."),
    }


def _common(direction: str) -> dict[str, Schema]:
    echo = one_of(
        ("required", "optional"),
        "Repeats the request's field of this name; `optional`: older firmware leaves it out.",
    )
    return {
        "doc": free_doc(),
        "range": range_of("Narrower than the type's, in the type's unit."),
        **({"echo": echo} if direction == "reply" else {}),
        "optional": yes("May be left out; only the last fields can be."),
        "const": whole("Always this number; the caller does not give it."),
    }


def plain_field(where: Schema, direction: str) -> Schema:
    """A field with a type."""
    by = name("Another field of the message, which decides the type; then `cases` tell it.")
    required = {"name": name("The argument's or result's name."), "is": where}
    return closed(f"A field of the {direction}.", required, {**_common(direction), "by": by})


def selected_field(direction: str) -> Schema:
    """A field whose type another one decides."""
    required = {
        "name": name("The argument's or result's name."),
        "by": name("The field that decides: an enum, or a few whole numbers."),
        "cases": named(ref("case"), "A type for each value of that field.", r"^[A-Z0-9-]"),
    }
    return closed("A field whose type another one decides.", required, _common(direction))


def _text(more: Schema) -> Schema:
    required = {"text": text("`word {field} word {field}`."), **more}
    fields = {"fields": listed(ref("text_field"), "The fields, in the text's order.")}
    if more:
        required["silence_ms"] = whole("Its end shows by silence: how long.", 1)
    return closed("Text outside any frame.", required, fields)
