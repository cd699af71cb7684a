"""The edition file, and everything that may stand right in it."""

from __future__ import annotations

from cobotwire_codegen.author.schema.leaves import (
    CLASS,
    Schema,
    by_key,
    closed,
    either,
    free,
    listed,
    name,
    ref,
    text,
    whole,
    words,
)
from cobotwire_codegen.build.parts import SECTIONS

# A file is told by a key that it must have. An edition has many of the others' keys: it is first.
FILES = (
    ("edition", "edition"),
    ("family", "commands_file"),
    ("changes", "changes_file"),
    ("vectors", "vectors_file"),
    ("errata", "errata_file"),
    ("frame", "frame_file"),
    *((section, "types_file") for section in SECTIONS),
)
_PATH: Schema = {"type": "string", "description": "A file, relative to this one."}


def edition_definitions() -> dict[str, Schema]:
    """An edition that stands alone, and one that stands on another."""
    own, parts = _own(), _parts()
    base = name("The edition that this one starts from.", r"\.yaml$")
    joints = {"joints": whole("How many joints the arm has.", 0)}
    needed = {"frame": parts.pop("frame")}
    changes = listed(_or_file("changes_file"), "What differs from the base, in order.")
    delta = {**own, "base": base}
    return {
        "edition": by_key([("base", ref("delta_edition"))], ref("whole_edition")),
        "whole_edition": closed(
            "An edition of a protocol.",
            {**own, **joints, **needed},
            {**_more(), **parts, "base": base},
        ),
        "delta_edition": closed(
            "An edition that starts from another one.",
            delta,
            {**_more(), **joints, **needed, **parts, "changes": changes},
        ),
        "acks": _acks(),
    }


def _own() -> dict[str, Schema]:
    return {
        "edition": name("The edition's name: the generated package."),
        "class": name("The class in the generated Python.", CLASS),
        "title": text("A heading."),
        "doc": text("What it is, in a sentence or two."),
    }


def _more() -> dict[str, Schema]:
    return {
        "document": free("The document that it was taken from."),
        "firmware": free("The firmware that speaks it."),
    }


def _parts() -> dict[str, Schema]:
    commands = listed(_or_file("commands_file"), "The commands, a file for each family.")
    return {
        "frame": _or_file("frame_file"),
        "types": _or_file("types_file"),
        "commands": either("array", commands, ref("commands")),
        "vectors": _entries("vectors"),
        "errata": _entries("errata"),
        "acks": ref("acks"),
    }


def _or_file(definition: str) -> Schema:
    return either("string", _PATH, ref(definition))


def _entries(key: str) -> Schema:
    """A file, or a list of files and of entries that stand right there."""
    entry = by_key([(key, ref(f"{key}_file"))], ref({"vectors": "vector"}.get(key, "erratum")))
    item = either("string", _PATH, entry)
    return either("array", listed(item, f"The {key}."), _or_file(f"{key}_file"))


def _acks() -> Schema:
    return closed(
        "Every command that nothing else answers gets this reply, as an acknowledgement.",
        {"field": ref("plain_reply_field"), "why": text("The reason.")},
        {"except": words("Commands that are not acknowledged.")},
    )
