"""Requests whose arguments get other names while optional ones come or go."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cobotwire_codegen.diff import diff
from cobotwire_codegen.model import Edition

Build = Callable[..., Edition]
BEFORE = "request: [{name: pin, is: pin}]"
WHY = "        why: The firmware says so."


def field(words: str) -> str:
    """A field of a request: ``name`` or ``name type``, with a ? where it is optional."""
    name, type = [*words.rstrip("?").split(), "speed"][:2]
    return f"{{name: {name}, is: {type}{', optional: true' if words.endswith('?') else ''}}}"


def request(*forms: str) -> str:
    lists = [f"[{', '.join(field(one) for one in form.split(', '))}]" for form in forms]
    return f"request: {lists[0]}" if len(lists) == 1 else f"request_forms: [{', '.join(lists)}]"


def said(old: Edition, new: Edition) -> list[str]:
    at = "commands/get_pin/"
    found = diff(old, new)
    return [f"{one.level} {one.rule} {one.where.split(at)[-1]}" for one in found]


CASES = {
    "renamed, one more": (
        ["channel, level"],
        ["channel, lvl, more?"],
        ["api argument-renamed request/lvl", "addition argument-added-optional request/more"],
    ),
    "renamed, two more": (
        ["channel, level"],
        ["channel, lvl, more?, most?"],
        [
            "api argument-renamed request/lvl",
            "addition argument-added-optional request/more",
            "addition argument-added-optional request/most",
        ],
    ),
    "an optional one renamed": (
        ["channel, level?"],
        ["channel, lvl?, more?"],
        ["api argument-renamed request/lvl", "addition argument-added-optional request/more"],
    ),
    "all renamed": (
        ["channel, level"],
        ["chan, lvl, more?"],
        [
            "api argument-renamed request/chan",
            "api argument-renamed request/lvl",
            "addition argument-added-optional request/more",
        ],
    ),
    "renamed, the optional one went": (
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
    "one more that must be sent": (
        ["channel"],
        ["channel, lvl, more?"],
        [
            "wire argument-added-required request/lvl",
            "addition argument-added-optional request/more",
        ],
    ),
    "a form is longer, another goes without": (
        ["channel", "pin pin, channel"],
        ["channel", "pin pin, channel, more"],
        [
            "wire request-form-removed get_pin/request",
            "addition argument-added-optional request/more",
        ],
    ),
}


@pytest.mark.parametrize(("before", "after", "expected"), CASES.values(), ids=list(CASES))
def test_forms(before: list[str], after: list[str], expected: list[str], build: Build) -> None:
    old, new = (build([(BEFORE, request(*side))]) for side in (before, after))
    assert sorted(said(old, new)) == sorted(one.replace("get_pin/", "") for one in expected)


def test_a_delta_that_renames_and_adds(build: Build) -> None:
    """Neither side writes the request where the other one does."""
    change = f"""{WHY}
        evidence: [{{source: firmware, says: so}}]
      - change: get_pin
        set: {{{request("port pin, more?")}}}
{WHY}"""
    found = said(build(file="delta"), build([(WHY, change)], file="delta"))
    assert "api argument-renamed request/port" in found
    assert "addition argument-added-optional request/more" in found
    assert not [one for one in found if one.startswith("wire")]
