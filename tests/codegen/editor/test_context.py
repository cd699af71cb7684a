"""The position of the cursor decides which keys and values the editor proposes."""

from __future__ import annotations

import pytest

from cobotwire_codegen.editor.complete import completions

COMMANDS = """\
family: motion
title: Motion
doc: It moves.
commands:
  get_angles:
    id: 0x20
    request:
      - {name: a, type: angle}
      - name: b
        type: speed
        |
"""


def proposed(text: str) -> list[str]:
    before = text.partition("|")[0]
    line = before.count("\n")
    found = completions(None, text.replace("|", ""), line, len(before) - (before.rfind("\n") + 1))
    return [each.label for each in found]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (COMMANDS, {"name", "type", "doc", "const"}),
        (COMMANDS.replace("        |", "      - |"), {"name", "type"}),
        (COMMANDS.replace("        |", "    |"), {"safety", "reply", "role"}),
        (COMMANDS.replace("        |", "    safety: |"), {"query", "motion", "power"}),
        (COMMANDS.replace("        |", "  "), set()),
        ("edition: a\n|", {"title", "frame", "commands"}),
        ("edition: a\nframe:\n  frame:\n    check: |", {"footer", "sum"}),
        ("edition: a\nframe: {transport: {parity: |", {"none", "even", "odd"}),
        ("changes:\n- change: x\n  set: {|", {"safety", "title"}),
        ("changes:\n  - change: x\n    request:\n      - {add: {|", {"name", "type"}),
        ("quantities:\n  angle: {wire: word, unit: |", {"degree", "volt", "ampere"}),
        ("vectors:\n  - name: a\n    direction: |", {"request", "reply"}),
        ("nonsense: [}{|", set()),
        ("", set()),
    ],
)
def test_proposals_follow_from_the_position(text: str, expected: set[str]) -> None:
    assert expected <= set(proposed(text))


def test_completion_raises_nothing_at_any_position_of_incomplete_text() -> None:
    text = COMMANDS.replace("|", "")
    for end in range(len(text)):
        cut = text[:end]
        completions(None, cut, cut.count("\n"), end - (cut.rfind("\n") + 1))
