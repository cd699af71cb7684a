"""The suite of the codec runner: broken and correct codecs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

from cobotwire import codec as codecs
from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.codec import Question, Run, derive_questions
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.conformance.report import Report
from cobotwire.protocol.table import Table
from mutation.codec.answers import ANSWERS, turned
from mutation.codec.formats import wrong_formats
from mutation.codec.framers import broken_framers
from mutation.codec.mutant import CodecMutant
from mutation.codec.reasons import reason
from mutation.suite import Case, Outcome, RightRun
from mutation.tables import wrong_tables

RUNS = 10


class CodecSuite:
    """See :class:`mutation.suite.Suite`."""

    def __init__(self, table: Table) -> None:
        self._table = table
        self._mutants = {mutant.id: mutant for mutant in codec_mutants(table)}
        self.name = f"codec, {table.edition}"

    def cases(self) -> Sequence[Case]:
        """Return every mutant of the edition's codec."""
        return [Case(mutant.id, mutant.kind) for mutant in self._mutants.values()]

    def judge(self, case: Case) -> Outcome:
        """Ask questions until a test case fails; if none fails, state the reason."""
        mutant = self._mutants[case.id]
        found = _complaint(
            Run(self._table, mutant.make()).ask_all(self._about(mutant.command), until_failure=True)
        )
        return Outcome(case, found, "" if found else reason(self._table, mutant))

    def right_runs(self) -> Sequence[str]:
        """Return the names of the runs with our own codecs, which are correct."""
        names = ("native", "reference")
        return [f"{name} {number}" for name in names for number in range(RUNS)]

    def accept(self, run: str) -> RightRun:
        """Ask a correct codec every question."""
        name = "native" if run.startswith("native") else "reference"
        codec = OurCodec(codecs.load(self._table, name))  # type: ignore[arg-type]
        found = _complaint(Run(self._table, codec).ask_all(self._questions))
        return RightRun(run, not found, found)

    @cached_property
    def _questions(self) -> list[Question]:
        return list(derive_questions(self._table))

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


def codec_mutants(table: Table) -> list[CodecMutant]:
    """Return every mutant of an edition's codec in a fixed order, with unique ids."""
    return [*_of_tables(table), *_of_rows(table), *_of_framers(table), *_of_answers(table)]


def _of_tables(table: Table) -> Iterator[CodecMutant]:
    for wrong in wrong_tables(table):
        yield CodecMutant(
            wrong.kind,
            wrong.id,
            wrong.place.command,
            lambda found=wrong.table: OurCodec(ReferenceCodec(found)),  # type: ignore[misc]
            wrong.place,
            wrong.table,
        )


def _of_rows(table: Table) -> Iterator[CodecMutant]:
    for command in table.commands:
        for direction in ("request", "reply"):
            names = {
                field.name
                for variant in command.variants(direction)
                for field in variant.fields
                if field.many
            }
            for name in sorted(names):
                for first_two in (False, True):
                    how = "first two swapped" if first_two else "last element first"
                    yield CodecMutant(
                        "order",
                        f"order: {command.name} {direction}: {name} {how}",
                        command.name,
                        lambda c=command.name, d=direction, n=name, f=first_two: turned(  # type: ignore[misc]
                            table, c, d, n, f
                        ),
                    )


def _of_framers(table: Table) -> Iterator[CodecMutant]:
    for name, broken in broken_framers():
        yield CodecMutant(
            "framing",
            f"framing: {name}",
            "",
            lambda make=broken: OurCodec(make(table)),  # type: ignore[misc]
        )


def _of_answers(table: Table) -> Iterator[CodecMutant]:
    for name, make in (*ANSWERS, *wrong_formats(table)):
        yield CodecMutant("check", f"check: {name}", "", lambda m=make: m(table))  # type: ignore[misc]


def _complaint(report: Report) -> str:
    return next((result.case for result in report.failures), "")
