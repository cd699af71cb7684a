"""Vectors and errata: what lies beside the spec."""

from __future__ import annotations

from cobotwire_codegen.author.schema.leaves import (
    METHOD,
    Schema,
    by_key,
    closed,
    free,
    hexed,
    lines,
    listed,
    name,
    one_of,
    ref,
    text,
    whole,
)
from cobotwire_codegen.author.schema.types import SOURCE
from cobotwire_codegen.model import ERRATUM_KINDS, REASONS, VERDICTS


def proof_definitions() -> dict[str, Schema]:
    """Vectors, errata and the files that hold them."""
    vectors = listed(ref("vector"), "Frames with the values that they carry.")
    errata = listed(ref("erratum"), "Where the document is wrong or contradicts itself.")
    return {
        "vectors_file": closed("Frames with the values that they carry.", {"vectors": vectors}),
        "vector": by_key([("example", ref("example_vector"))], ref("named_vector")),
        "example_vector": _example(),
        "named_vector": _named(),
        "refusal": closed(
            "Why the printed bytes are no legal frame.",
            {"reason": one_of(REASONS, "The framer's reason."), "offset": whole("The byte.", 0)},
        ),
        "errata_file": closed("Where the document is wrong.", {"errata": errata}),
        "erratum": _erratum(),
    }


def _common() -> dict[str, Schema]:
    return {
        "line": whole("Its line in the document.", 1),
        "printed": hexed("The bytes that the document prints."),
        "frame": hexed("The frame to build and to decode. Left out: a stray copy."),
        "text": free("The text of a reply outside any frame."),
        "values": {
            "type": "object",
            "description": "The fields in order: an enum by its member, a flag as true or false.",
        },
        "says": free("What it shows."),
        "refused": ref("refusal"),
        "source": SOURCE,
        "why": free("Where it comes from."),
    }


def _message() -> dict[str, Schema]:
    return {
        "command": name("The command that it shows.", METHOD),
        "direction": one_of(("request", "reply"), "Who sends it."),
    }


def _example() -> Schema:
    required = {
        "example": whole("Its number among the document's examples, from 1.", 1),
        **_message(),
        "verdict": one_of(VERDICTS, "Whether the printed bytes are right."),
    }
    return closed("An example that the document prints.", required, _common())


def _named() -> Schema:
    required = {"name": text("A name of its own."), **_message()}
    example = whole("Its number among the document's examples, instead of a name.", 1)
    return closed("A frame that the document lacks.", required, {**_common(), "example": example})


def _erratum() -> Schema:
    return closed(
        "A place where the document is wrong or contradicts itself.",
        {
            "line": lines("The lines: 12, 20-39, or a list of these."),
            "kind": one_of(ERRATUM_KINDS, "What is wrong."),
            "says": text("What the document says there."),
            "read": text("How it is read."),
            "why": text("Why it is read so."),
        },
        {
            "commands": listed({"type": "string"}, "Left out: the link or the frame."),
            "example": whole("The example that is wrong, from 1.", 1),
        },
    )
