"""Codes of vectors, errata and disputes: the spec against what lies beside it."""

from __future__ import annotations

from cobotwire_codegen.author.codes.explanation import Explanation

EXPLANATIONS = (
    Explanation(
        "unknown-command",
        "A vector, erratum, alias, change or exception names a command that does not exist.",
        "What it says would be lost.",
        "Correct the spelling; in a delta, use the name that the command has at that point.",
        "command: blnk",
        "command: blink",
    ),
    Explanation(
        "vector-differs",
        "The values of a vector build other bytes than the vector shows.",
        "Either the spec or the vector is wrong; both feed the tests.",
        "The message shows the bytes that the values build: see which of the two is right.",
        "values: {brightness: 51, colour: RED}",
        "values: {brightness: 50, colour: RED}",
    ),
    Explanation(
        "vector-unsayable",
        "The values of a vector cannot be sent: wrong fields, or a value that is not legal.",
        "A vector shows a legal message.",
        "Give the fields of one form, in order, with values inside their types.",
        "values: {brightness: 150, colour: RED}",
        "values: {brightness: 50, colour: RED}",
    ),
    Explanation(
        "no-vector",
        "No vector shows a message of a command, or one of its forms.",
        "Without an example from outside, a mistake in the layout would go unseen.",
        "Add one to a vectors file, best a frame that was seen on a line; "
        "`cobotwire-gen new-command` writes the first ones.",
        "# Nothing shows reset.",
        "- name: reset-request\n  command: reset\n  direction: request\n  frame: FE FE 01 02 02 02",
    ),
    Explanation(
        "unexplained-example",
        "A printed example is not read as it stands, and no erratum says why.",
        "Every place where the document is wrong is kept with its reason.",
        "Add an erratum with the example's number, or correct the verdict or the frame.",
        "verdict: erratum",
        "verdict: consistent",
    ),
    Explanation(
        "no-evidence",
        "A dispute or change has no evidence.",
        "A reading against a source needs a source.",
        "List at least one {source, says}, with `lines` where it has lines.",
        "evidence: []",
        "evidence: [{source: the lamp, says: silence}]",
    ),
    Explanation(
        "duplicate-vector",
        "Two vectors have the same name.",
        "A test that fails names its vector; a delta withdraws one by its name.",
        "Rename one, or give one example another number.",
        "- name: read-request\n  command: read_angle\n  direction: reply",
        "- name: read-reply\n  command: read_angle\n  direction: reply",
    ),
)
