"""The codec runner's suite: codecs broken in one place, and the right ones."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

from cobotwire import codec as codecs
from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.codec import Run, Trial, derive
from cobotwire.conformance.codec.adapter.ours import OurCodec
from cobotwire.conformance.report import Report, Verdict
from cobotwire.table import Table
from mutation import suite
from mutation.codec.answers import ANSWERS, turned
from mutation.codec.framers import broken_framers
from mutation.codec.mutant import CodecMutant
from mutation.codec.reasons import reason
from mutation.suite import Case, Outcome
from mutation.tables import wrong_tables

RUNS = 10


class CodecSuite:
    """See :class:`mutation.suite.Suite`."""

    def __init__(self, table: Table) -> None:
        self._table = table
        self._mutants = {mutant.id: mutant for mutant in codec_mutants(table)}
        self.name = f"codec, {table.edition}"

    def cases(self) -> Sequence[Case]:
        """Every mutant of the edition's codec."""
        return [Case(mutant.id, mutant.kind) for mutant in self._mutants.values()]

    def judge(self, case: Case) -> Outcome:
        """Ask until something is wrong; where nothing is, say why nobody could tell."""
        mutant = self._mutants[case.id]
        found = _complaint(
            Run(self._table, mutant.make()).ask_all(self._about(mutant.command), until_failure=True)
        )
        return Outcome(case, found, "" if found else reason(self._table, mutant))

    def trials(self) -> Sequence[str]:
        """Both codecs, again and again."""
        names = ("native", "reference")
        return [f"{name} {number}" for name in names for number in range(RUNS)]

    def accept(self, trial: str) -> suite.Trial:
        """Ask a right codec everything."""
        name = "native" if trial.startswith("native") else "reference"
        codec = OurCodec(codecs.load(self._table, name))  # type: ignore[arg-type]
        found = _complaint(Run(self._table, codec).ask_all(self._trials))
        return suite.Trial(trial, not found, found)

    @cached_property
    def _trials(self) -> list[Trial]:
        return list(derive(self._table))

    @cached_property
    def _by_command(self) -> dict[str, list[Trial]]:
        found: dict[str, list[Trial]] = {}
        for trial in self._trials:
            found.setdefault(trial.command, []).append(trial)
        return found

    def _about(self, command: str) -> Iterator[Trial]:
        """The trials of a command, then those of none; for a fault of no command all of them.

        More trials could only find more.
        """
        if not command:
            yield from self._trials
            return
        yield from self._by_command.get(command, [])
        yield from self._by_command.get("", [])


def codec_mutants(table: Table) -> list[CodecMutant]:
    """Every mutant of an edition's codec, in a fixed order; no two ids are alike."""
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
                for layout in command.layouts(direction)
                for field in layout.fields
                if field.many
            }
            for name in sorted(names):
                for first_two in (False, True):
                    how = "first two changed over" if first_two else "last element first"
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
    for name, make in ANSWERS:
        yield CodecMutant("check", f"check: {name}", "", lambda m=make: m(table))  # type: ignore[misc]


def _complaint(report: Report) -> str:
    for result in report.results:
        if result.verdict in (Verdict.FAIL, Verdict.UNSTABLE):
            return result.rule
    return ""
