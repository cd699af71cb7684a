"""Codes of vectors, errata and disputes."""

from __future__ import annotations

from cobotwire_codegen.author.codes.explanation import Explanation

EXPLANATIONS = (
    Explanation(
        "unknown-command",
        "A vector, erratum, alias, change or exception names a command that does not exist.",
        "The entry would have no effect.",
        "Correct the spelling; in a delta, use the name that the command has at that point.",
        "command: blnk",
        "command: blink",
    ),
    Explanation(
        "bad-start-value",
        "A start is not a value of its state's type, or lies outside a limit.",
        "A simulated device would report a value that no real device can send.",
        "Give a value that the type allows, as a vector has it.",
        "level: {type: angle, start: 1000}",
        "level: {type: angle, start: 10}",
    ),
    Explanation(
        "bad-state",
        "A state has the name of a built-in state, which every arm has.",
        "The simulator computes built-in states, so a declaration would have no effect.",
        "Remove the declaration, or rename the state.",
        "state:\n  moving: {type: flag}",
        "state:\n  level: {type: angle, start: 10}",
    ),
    Explanation(
        "vector-differs",
        "The values of a vector encode to other bytes than its frame.",
        "Either the spec or the vector is wrong, and tests are generated from both.",
        "The message shows the encoded bytes; find out which of the two is right.",
        "values: {brightness: 51, colour: RED}",
        "values: {brightness: 50, colour: RED}",
    ),
    Explanation(
        "limit-differs",
        "A vector states that a field accepts or refuses a value, and the spec differs.",
        "The ends of a range are facts, and the vector states what its source says about them.",
        "Find out which of the two is right; correct the range, or the vector's values.",
        "values: {brightness: 50, colour: RED}\nrefused: {brightness: [100]}",
        "values: {brightness: 50, colour: RED}",
    ),
    Explanation(
        "unencodable-vector",
        "The values of a vector cannot be encoded: wrong fields, or an illegal value.",
        "A vector must show a legal message.",
        "Give the fields of one variant, in order, with values inside their types.",
        "values: {brightness: 150, colour: RED}",
        "values: {brightness: 50, colour: RED}",
    ),
    Explanation(
        "no-vector",
        "No vector shows a message of a command, or one of its variants.",
        "Without an example from outside, a mistake in the variant would go unnoticed.",
        "Add one to a vectors file, preferably a captured frame; "
        "`cobotwire-gen new-command` writes the first ones.",
        "# Nothing shows reset.",
        "- name: reset-request\n  command: reset\n  direction: request\n  frame: FE FE 01 02 02 02",
    ),
    Explanation(
        "unexplained-example",
        "A printed example differs from its verdict or frame, and no erratum explains why.",
        "Every mistake of the document is recorded with its reason.",
        "Add an erratum with the example's number, or correct the verdict or the frame.",
        "verdict: erratum",
        "verdict: consistent",
    ),
    Explanation(
        "unknown-fact",
        "An evidence file names a part or an aspect that the command does not have.",
        "What an arm showed is listed at the part that it is about, so that part must exist.",
        "Write COMMAND/PART/ASPECT; after a field was renamed, rename it in the evidence too.",
        "- fact: light/reply.lit/range",
        "- fact: light/request.lit/range",
    ),
    Explanation(
        "no-evidence",
        "A dispute or change has no evidence.",
        "A reading that contradicts a source needs a source of its own.",
        "List at least one {source, says}, with `lines` if the source is the document.",
        "evidence: []",
        "evidence: [{source: the lamp, says: silence}]",
    ),
    Explanation(
        "duplicate-vector",
        "Two vectors have the same name.",
        "Tests and deltas refer to vectors by name.",
        "Rename one, or correct the number of one example.",
        "- name: read-request\n  command: read_angle\n  direction: reply",
        "- name: read-reply\n  command: read_angle\n  direction: reply",
    ),
)
