"""Codes of the arguments of methods: defaults, order, and the variants that they choose."""

from __future__ import annotations

from cobotwire_codegen.author.codes.explanation import Explanation

EXPLANATIONS = (
    Explanation(
        "same-arguments",
        "Two variants of a message have the same arguments.",
        "The arguments of a call choose the variant. Constants are not arguments, so nothing would "
        "choose between the two.",
        "Rename a field in one variant, or make one a command of its own with `shares_id`.",
        "request_variants:\n"
        "  - [{name: part, type: count}, {name: kind, type: count, const: 1}]\n"
        "  - [{name: part, type: length}, {name: kind, type: count, const: 2}]",
        "request_variants:\n  - [{name: part, type: count}]",
    ),
    Explanation(
        "bad-default",
        "The type of an argument does not allow its default, or the argument has `const` or "
        "`optional` too.",
        "A call without the argument could not be encoded, or would have two meanings.",
        "Correct the value, or keep one of the keys.",
        "- {name: fade, type: flag, default: 2}",
        "- {name: fade, type: flag, optional: true}",
    ),
    Explanation(
        "bad-arguments",
        "`arguments` does not list every argument once, or lists an optional argument before a "
        "required one.",
        "The list is the order of the method's arguments, and Python wants those without a default "
        "first.",
        "Correct the list; it names fields of the request and parts of its text.",
        "safety: motion\narguments: [axis, aim]",
        "safety: motion",
    ),
)
