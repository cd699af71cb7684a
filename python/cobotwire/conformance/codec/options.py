"""The options of a run on a codec, as a report keeps them."""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from fnmatch import fnmatchcase

from cobotwire.conformance.codec.questions.question import Question
from cobotwire.conformance.codec.suite import derive_questions
from cobotwire.conformance.options import Options
from cobotwire.protocol.table import Table


@dataclass(frozen=True, slots=True)
class CodecOptions(Options):
    """What a caller chooses for a run.

    ``command`` runs the codec. ``only`` is a pattern for the names of the questions to ask.
    """

    kind = "codec"

    command: str = ""
    only: str = ""
    timeout: float = 10.0
    repeat: int = 1

    @property
    def words(self) -> list[str]:
        """The words of the command."""
        return shlex.split(self.command)

    def questions(self, table: Table) -> Iterator[Question]:
        """Yield the questions to ask, in their order."""
        for each in derive_questions(table):
            if not self.only or fnmatchcase(each.name, self.only):
                yield each
