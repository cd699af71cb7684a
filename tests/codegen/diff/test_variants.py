"""Compare requests with renamed arguments while optional ones are added or removed."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cobotwire_codegen.diff import diff
from cobotwire_codegen.model import Edition

Build = Callable[..., Edition]
BEFORE = "request: [{name: pin, type: pin}]"
WHY = "        why: The firmware says so."


def field(words: str) -> str:
    """Return a field of a request from ``name`` or ``name type``; ``?`` marks it optional."""
    name, type = [*words.rstrip("?").split(), "speed"][:2]
    return f"{{name: {name}, type: {type}{', optional: true' if words.endswith('?') else ''}}}"


def request(*variants: str) -> str:
    lists = [f"[{', '.join(field(one) for one in variant.split(', '))}]" for variant in variants]
    return f"request: {lists[0]}" if len(lists) == 1 else f"request_variants: [{', '.join(lists)}]"


def findings(old: Edition, new: Edition) -> list[str]:
    at = "commands/get_pin/"
    found = diff(old, new)
    return [f"{one.level} {one.rule} {one.where.split(at)[-1]}" for one in found]


CASES = {
    "renamed, the optional one removed": (
        ["channel, level, more?"],
        ["channel, lvl"],
        ["wire argument-removed request/more", "api argument-renamed request/lvl"],
    ),
    "another type is another argument": (
        ["channel, level"],
        ["channel, lvl angle, more?"],
        [
            "wire argument-removed request/level",
            "wire argument-added-required request/lvl",
            "addition argument-added-optional request/more",
        ],
    ),
    "one variant is longer, another lacks the new argument": (
        ["channel", "pin pin, channel"],
        ["channel", "pin pin, channel, more"],
        [
            "wire request-variant-removed get_pin/request",
            "addition argument-added-optional request/more",
        ],
    ),
}


@pytest.mark.parametrize(("before", "after", "expected"), CASES.values(), ids=list(CASES))
def test_changed_arguments_have_exactly_the_expected_findings(
    before: list[str], after: list[str], expected: list[str], build: Build
) -> None:
    old, new = (build([(BEFORE, request(*side))]) for side in (before, after))
    assert sorted(findings(old, new)) == sorted(one.replace("get_pin/", "") for one in expected)


def test_argument_renamed_by_a_delta_is_reported(build: Build) -> None:
    """The old side writes the request in its base, the new side in its delta."""
    change = f"""{WHY}
        evidence: [{{source: firmware, says: so}}]
      - change: get_pin
        set: {{{request("port pin, more?")}}}
{WHY}"""
    found = findings(build(file="delta"), build([(WHY, change)], file="delta"))
    assert "api argument-renamed request/port" in found
    assert "addition argument-added-optional request/more" in found
    assert not [one for one in found if one.startswith("wire")]
