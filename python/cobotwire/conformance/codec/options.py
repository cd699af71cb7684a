"""The options of a run on a codec, as a report keeps them."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from fnmatch import fnmatchcase
from typing import Any

from cobotwire.conformance.codec.questions.question import Question
from cobotwire.conformance.codec.suite import derive_questions
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Table

# The options that are numbers; the others are text.
NUMBERS: Mapping[str, type] = {"timeout": float, "repeat": int}


@dataclass(frozen=True, slots=True)
class CodecOptions:
    """What a caller chooses for a run.

    ``command`` runs the codec. ``expected`` is the text of the file of known failures, and
    ``expected_name`` its name. ``only`` is a pattern of the questions that are asked.
    """

    command: str = ""
    expected: str = ""
    expected_name: str = ""
    only: str = ""
    timeout: float = 10.0
    repeat: int = 1

    @classmethod
    def of_report(cls, options: Mapping[str, Any]) -> CodecOptions:
        """Return the options that a report keeps.

        Raises:
            UsageError: an option is unknown or illegible.
        """
        known = {field.name for field in fields(cls)}
        if set(options) - known or not options.get("command"):
            message = "the report does not hold the options of a run on a codec"
            raise UsageError("report", message=message)
        try:
            return cls(**{name: NUMBERS.get(name, str)(t) for name, t in options.items()})
        except (TypeError, ValueError) as error:
            raise UsageError("report", message=f"its options: {error}") from error

    def for_report(self) -> dict[str, str]:
        """Return the options that differ from their defaults."""
        given = {field.name: getattr(self, field.name) for field in fields(self)}
        usual = {field.name: field.default for field in fields(self)}
        return {name: str(value) for name, value in given.items() if value != usual[name]}

    @property
    def words(self) -> list[str]:
        """The words of the command."""
        return shlex.split(self.command)

    def questions(self, table: Table) -> Iterator[Question]:
        """Yield the questions to ask, in their order."""
        for each in derive_questions(table):
            if not self.only or fnmatchcase(each.name, self.only):
                yield each
