"""What a codec is asked, and what it must answer; both as the line protocol writes them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

Json = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Trial:
    """One question of ``docs/codec-protocol.md`` with the right answer.

    ``name`` is unique and stable: files of expected failures speak of it. ``ask`` lacks the ``id``.
    ``expect`` holds one of ``bytes``, ``fields``, ``refused``, ``events``.
    """

    name: str
    rule: str
    command: str
    ask: Json
    expect: Json

    @property
    def needs(self) -> str:
        """The ability that the question asks for, as the greeting names it: ``decode reply``."""
        return f"{self.ask['do']} {self.ask['direction']}"
