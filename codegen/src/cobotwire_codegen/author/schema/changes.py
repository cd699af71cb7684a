"""Changes files: what a delta does to its base."""

from __future__ import annotations

from cobotwire_codegen.author.schema.leaves import (
    METHOD,
    Schema,
    by_key,
    closed,
    free,
    listed,
    name,
    one_of,
    ref,
    text,
    words,
)
from cobotwire_codegen.build.delta import OPERATIONS

_FIELD_VERBS = {
    "add": "A field to add.",
    "remove": "A field to remove.",
    "rename": "A field to rename.",
    "change": "A field to change.",
}
_VERB_DOCS = {
    "remove": "Commands of the base that are gone.",
    "rename": "A command that has another name.",
    "change": "Commands that differ.",
    "change_type": "A type that differs.",
    "withdraw": "Vectors of the base that do not hold here.",
}


def change_definitions(definitions: dict[str, Schema]) -> dict[str, Schema]:
    """Changes, and the file that holds them; ``definitions`` say what can be set."""
    command, type = _some_of(definitions, "command"), _some_of(definitions, *_TYPES)
    more = {
        "remove": {},
        "rename": {"to": name("The new name.", METHOD)},
        "change": {
            **_set_and_unset(command),
            "request": listed(ref("request_change"), "Changes of the request's fields."),
            "reply": listed(ref("reply_change"), "Changes of the reply's fields."),
        },
        "change_type": _set_and_unset(type),
        "withdraw": {},
    }
    found = {f"{verb}_change": _change(verb, more[verb]) for verb in OPERATIONS}
    found["change"] = _just_one({verb: f"{verb}_change" for verb in OPERATIONS})
    changes = listed(ref("change"), "The changes, in order.")
    found["changes_file"] = closed("What differs from the base.", {"changes": changes})
    for direction in ("request", "reply"):
        found.update(_field_changes(definitions, direction))
    return found


_TYPES = ("wire", "quantity", "flag", "enum", "value")


def _change(verb: str, more: dict[str, Schema]) -> Schema:
    # The other verbs are known too; that there is just one is said where one is picked.
    verbs = {verb: words(doc) for verb, doc in _VERB_DOCS.items()}
    required = {
        verb: verbs.pop(verb),
        "why": text("The reason."),
        "evidence": listed(ref("evidence"), "Who says so.", 1),
    }
    needed = {"to": more["to"]} if "to" in more else {}
    optional = {key: schema for key, schema in more.items() if key != "to"}
    return closed(_VERB_DOCS[verb], {**required, **needed}, {**optional, **verbs})


def _field_changes(definitions: dict[str, Schema], direction: str) -> dict[str, Schema]:
    kinds = (f"plain_{direction}_field", f"selected_{direction}_field")
    field = _some_of(definitions, *kinds)
    more = {
        "add": {"after": free("The field that it stands behind. Left out: at the end.")},
        "remove": {},
        "rename": {"to": name("The new name.")},
        "change": _set_and_unset(field),
    }
    found = {}
    for verb in _FIELD_VERBS:
        verbs = {other: free(doc) for other, doc in _FIELD_VERBS.items() if other != "add"}
        verbs["add"] = ref(f"{direction}_field")
        optional = {**more[verb], **{key: verbs[key] for key in verbs if key != verb}}
        needed = {verb: verbs[verb]}
        if verb == "rename":
            needed["to"] = optional.pop("to")
        found[f"{verb}_{direction}_field"] = closed(_FIELD_VERBS[verb], needed, optional)
    names = {verb: f"{verb}_{direction}_field" for verb in _FIELD_VERBS}
    found[f"{direction}_change"] = _just_one(names)
    return found


def _just_one(verbs: dict[str, str]) -> Schema:
    alone = [{"required": [verb]} for verb in verbs]
    first = next(iter(verbs.values()))
    return {"oneOf": alone, **by_key([(v, ref(kind)) for v, kind in verbs.items()], ref(first))}


def _set_and_unset(properties: dict[str, Schema]) -> dict[str, Schema]:
    return {
        "set": closed("Keys with their new content.", {}, properties),
        "unset": words("Keys that are left out here.", one_of(properties, "A key.")),
    }


def _some_of(definitions: dict[str, Schema], *names: str) -> dict[str, Schema]:
    """The keys of some definitions, none of them required."""
    merged: dict[str, Schema] = {}
    for definition in names:
        merged.update(definitions[definition]["properties"])
    return merged
