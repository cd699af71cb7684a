"""The options of a run, as a report keeps them, so that the run can be repeated from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar, Self

from cobotwire.conformance.expected import Expectation, read_expectations
from cobotwire.conformance.report import Kind
from cobotwire.protocol.errors import UsageError

# The function that reads the text of an option, by its annotation; other options are texts.
READERS: Mapping[str, type] = {"int": int, "float": float, "bool": bool}


@dataclass(frozen=True, slots=True)
class Options:
    """What a caller chooses for a run, in the words of the command line.

    ``expected`` is the text of the file of known failures, and ``expected_name`` its name.
    """

    kind: ClassVar[Kind]

    expected: str = field(default="", kw_only=True)
    expected_name: str = field(default="", kw_only=True)

    def known_failures(self) -> list[Expectation]:
        """Return the lines of the file of known failures.

        Raises:
            UsageError: a line has no reason, or repeats the name of another line.
        """
        return read_expectations(self.expected, self.expected_name)

    @classmethod
    def of_report(cls, options: Mapping[str, Any]) -> Self:
        """Return the options that a report keeps.

        Raises:
            UsageError: an option is unknown, or its text is not a value of it.
        """
        readers = {
            each.name: READERS.get(str(each.type).removesuffix(" | None"), str)
            for each in fields(cls)
        }
        values: dict[str, Any] = {}
        for name, text in options.items():
            if name not in readers:
                message = (
                    f"the report has an option that a run on a {cls.kind} does not have: {name}"
                )
                raise UsageError("report", name, message=message)
            try:
                values[name] = readers[name](text)
            except (TypeError, ValueError) as error:
                raise UsageError("report", message=f"its option {name}: {error}") from error
        return cls(**values)

    def for_report(self) -> dict[str, str]:
        """Return the options that differ from their defaults."""
        return {
            each.name: str(getattr(self, each.name))
            for each in fields(self)
            if getattr(self, each.name) != each.default
        }
