"""Codes of changes: what a delta does to its base, and waivers of differences."""

from __future__ import annotations

from cobotwire_codegen.author.codes.explanation import Explanation

EXPLANATIONS = (
    Explanation(
        "bad-change",
        "A change does nothing, or several things at once.",
        "Changes are applied in order; each does one thing, with its own reason and evidence.",
        "Split the change, or name what it does.",
        "- remove: [read_angle]\n  rename: move\n  why: It is gone.",
        "- remove: [read_angle]\n  why: It is gone.",
    ),
    Explanation(
        "nothing-to-unset",
        "A change unsets a key that does not exist.",
        "The base is not as the change expects; it may have been corrected there.",
        "Correct the key, or remove the change.",
        "unset: [alias]",
        "unset: [safety]",
    ),
    Explanation(
        "unknown-field",
        "A change names a field that the message does not have at that point.",
        "The base is not as the change expects.",
        "Correct the spelling; fields are changed in the order of the list.",
        "- {remove: fad}",
        "- {remove: fade}",
    ),
    Explanation(
        "unknown-vector",
        "A change withdraws a vector that the base does not have.",
        "The base is not as the change expects.",
        "Name the vector by its `name`, or as example-N.",
        "- withdraw: [light]",
        "- withdraw: [light-request]",
    ),
    Explanation(
        "unknown-rule",
        "A waiver names a rule of `cobotwire-gen diff` that does not exist.",
        "The waiver would have no effect, and the finding would still stop the build.",
        "Correct the spelling; the finding that you want to waive names its rule.",
        "- {rule: command-remove, where: read_angle, reason: Nobody calls it.}",
        "- {rule: command-removed, where: read_angle, reason: Nobody calls it.}",
    ),
)
