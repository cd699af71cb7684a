"""Codes of changes: what a delta does to its base, and waivers of differences."""

from __future__ import annotations

from cobotwire_codegen.author.codes.explanation import Explanation

EXPLANATIONS = (
    Explanation(
        "bad-change",
        "A change does nothing, or several things at once.",
        "Changes are applied in order; each is just one, with its own reason and evidence.",
        "Split it, or name what it does.",
        "- remove: [read_angle]\n  rename: move\n  why: It is gone.",
        "- remove: [read_angle]\n  why: It is gone.",
    ),
    Explanation(
        "nothing-there",
        "A change unsets a key that is not there.",
        "The base is not what the change believes; it may have been mended there.",
        "Correct the key, or drop the change.",
        "unset: [alias]",
        "unset: [safety]",
    ),
    Explanation(
        "unknown-field",
        "A change names a field that the message does not have at that point.",
        "The base is not what the change believes.",
        "Correct the spelling; fields are changed in the order of the list.",
        "- {remove: fad}",
        "- {remove: fade}",
    ),
    Explanation(
        "unknown-vector",
        "A change withdraws a vector that the base does not have.",
        "The base is not what the change believes.",
        "Name the vector by its `name`, or as example-N.",
        "- withdraw: [light]",
        "- withdraw: [light-request]",
    ),
    Explanation(
        "unknown-rule",
        "A waiver names a rule of `cobotwire-gen diff` that does not exist.",
        "It would waive nothing, and what it was meant for would stop the build.",
        "Correct the spelling; the difference that is to be waived tells its rule.",
        "- {rule: command-remove, where: read_angle, reason: Nobody calls it.}",
        "- {rule: command-removed, where: read_angle, reason: Nobody calls it.}",
    ),
)
