"""The suite of the codec runner: broken and correct codecs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property, partial
from typing import NamedTuple

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.codec import Implementation, Question, Run
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.protocol.table import Table
from conformance.codec.questions import questions_of
from mutation.codec.patches import ReorderingCodec, broken_framers, wrong_frames
from mutation.codec.reasons import reason
from mutation.suite import Suite
from mutation.tables import WrongTable, wrong_tables


class CodecMutant(NamedTuple):
    """A codec with one fault; ``make`` returns a new one.

    ``wrong`` is its table, if that is wrong. The questions about ``command`` come first; if it is
    empty, all questions are asked in order.
    """

    kind: str
    text: str
    command: str
    make: Callable[[], Implementation]
    wrong: WrongTable | None = None

    @property
    def id(self) -> str:
        """The name in tables."""
        return f"{self.kind}: {self.text}"


class CodecSuite(Suite):
    """Broken codecs, and our own two, which are correct."""

    right_runs: tuple[codecs.CodecName, ...] = ("native", "reference")

    def __init__(self, table: Table) -> None:
        super().__init__(table, codec_mutants(table))

    def killer(self, mutant: CodecMutant) -> str:
        """Ask questions until a test case fails."""
        return self._complaint(mutant.make(), self._about(mutant.command))

    def reason(self, mutant: CodecMutant) -> str:
        """Return why the table of a mutant equals the correct one; empty if it does not."""
        return reason(self.table, mutant.wrong) if mutant.wrong else ""

    def failure(self, run: str) -> str:
        """Ask a correct codec every question."""
        [name] = [name for name in self.right_runs if name == run]
        return self._complaint(OurCodec(codecs.load(self.table, name)), iter(self._questions))

    def _complaint(self, codec: Implementation, questions: Iterator[Question]) -> str:
        report = Run(self.table, codec).ask_all(questions, until_failure=True)
        return next((result.case for result in report.failures), "")

    @property
    def _questions(self) -> list[Question]:
        return questions_of(self.table.edition)

    @cached_property
    def _by_command(self) -> dict[str, list[Question]]:
        found: dict[str, list[Question]] = {}
        for question in self._questions:
            found.setdefault(question.command, []).append(question)
        return found

    def _about(self, command: str) -> Iterator[Question]:
        """Yield the questions about a command and then the general ones; without a command, all."""
        if not command:
            yield from self._questions
            return
        yield from self._by_command.get(command, [])
        yield from self._by_command.get("", [])


def codec_mutants(table: Table) -> Iterator[CodecMutant]:
    """Yield every mutant of an edition's codec in a fixed order, with unique ids."""
    for wrong in wrong_tables(table):
        make = partial(_answering, ReferenceCodec, wrong.table)
        yield CodecMutant(wrong.kind, wrong.name, wrong.place.command, make, wrong)
    for command in table.commands:
        for direction in ("request", "reply"):
            variants = command.variants(direction)
            fields = [field for variant in variants for field in variant.fields if field.many]
            for name in sorted({field.name for field in fields}):
                for first_two in (False, True):
                    how = "first two swapped" if first_two else "last element first"
                    text = f"{command.name} {direction}: {name} {how}"
                    codec = partial(
                        ReorderingCodec, table, command.name, direction, name, first_two
                    )
                    yield CodecMutant("order", text, command.name, codec)
    for name, broken in broken_framers():
        yield CodecMutant("framing", name, "", partial(_answering, broken, table))
    for name, wrong_frame in wrong_frames(table):
        yield CodecMutant("check", name, "", partial(_answering, wrong_frame, table))


def _answering(codec: Callable[[Table], Codec], table: Table) -> OurCodec:
    return OurCodec(codec(table))
