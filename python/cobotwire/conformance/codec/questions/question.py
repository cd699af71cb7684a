"""A question to a codec and its right answer; both as the line protocol writes them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cobotwire.conformance.suite import TestCase

Json = dict[str, Any]


def hexed(data: bytes) -> str:
    """Return bytes as the line protocol writes them."""
    return data.hex().upper()


@dataclass(frozen=True, slots=True)
class Question:
    """One question of ``docs/codec-protocol.md`` with the answer of the reference codec.

    ``name`` is unique and stable: files of expected failures use it. ``case`` is the test case
    that checks the answer. ``ask`` is the question without its ``id``, ``expect`` the right answer.
    """

    name: str
    case: TestCase
    command: str
    ask: Json
    expect: Json

    @property
    def needs(self) -> str:
        """The ability that it requires, as the greeting names it: ``decode reply``."""
        return f"{self.ask['do']} {self.ask['direction']}"
