"""A trial tries one command out and judges it by some rules; a case is one run of a trial."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from cobotwire.conformance.device.bench import Bench
from cobotwire.conformance.device.catalogue import Rule
from cobotwire.conformance.device.ending import Hopeless
from cobotwire.conformance.device.leave import class_of
from cobotwire.conformance.report import Result, Verdict
from cobotwire.table import Command, Table

# The evidence of a result: so many exchanges before the first thing that went wrong.
EVIDENCE = 12
# A case ends early where it goes on failing: the rest would say the same, slowly.
PATIENCE = 3


class _Said(NamedTuple):
    reason: str
    first: int
    last: int


class Case:
    """Collects what the rules say while a trial runs."""

    def __init__(self, bench: Bench, command: Command | None, rules: tuple[Rule, ...]) -> None:
        self.bench = bench
        self._command = command
        self._rules = [rule for rule in rules if command is None or rule.of(command)]
        self._failed: dict[Rule, list[_Said]] = {rule: [] for rule in self._rules}
        self._judged: dict[Rule, int] = dict.fromkeys(self._rules, 0)
        self._notes: dict[Rule, str] = {}
        self.began = bench.line.mark

    @property
    def command(self) -> Command:
        """The command that is tried."""
        assert self._command is not None
        return self._command

    def expect(self, rule: Rule, holds: bool, reason: str) -> bool:
        """Judge one observation; ``reason`` says what was expected and what came.

        Raises:
            Hopeless: it has failed often enough.
        """
        if rule not in self._judged:
            return holds
        self._judged[rule] += 1
        if not holds:
            mark = self.bench.line.mark
            self._failed[rule].append(_Said(reason, self.began, mark))
            if len(self._failed[rule]) >= PATIENCE:
                raise Hopeless
        return holds

    def without(self, rule: Rule) -> None:
        """Say that a rule has no meaning for this command."""
        self._rules = [other for other in self._rules if other is not rule]

    def note(self, rule: Rule, text: str) -> None:
        """Say something beside a verdict that passes."""
        self._notes[rule] = text

    def results(self, unsupported: str = "") -> list[Result]:
        """A result a rule."""
        return [self._result(rule, unsupported) for rule in self._rules]

    def not_allowed(self, missing: str) -> list[Result]:
        """The results of a trial that was not run: a result a rule."""
        name = self._command.name if self._command else ""
        source = self.bench.places.get(name, "")
        reason = f"It needs leave: {missing}."
        return [Result(r.id, name, Verdict.NOT_ALLOWED, reason, (), source) for r in self._rules]

    def _result(self, rule: Rule, unsupported: str) -> Result:
        name = self._command.name if self._command else ""
        source = self.bench.places.get(name, "")
        failed = self._failed[rule]
        if failed:
            more = f" (and {len(failed) - 1} more)" if len(failed) > 1 else ""
            evidence = self.bench.line.between(failed[0].first, failed[0].last, EVIDENCE)
            reason = failed[0].reason + more
            return Result(rule.id, name, Verdict.FAIL, reason, evidence, source)
        if not self._judged[rule]:
            reason = unsupported or "nothing came that could be judged by it"
            return Result(rule.id, name, Verdict.NOT_SUPPORTED, reason, (), source)
        reason = self._notes.get(rule, f"{rule.says} Held {self._judged[rule]} times.")
        evidence = self.bench.line.between(self.began, self.bench.line.mark, EVIDENCE)
        return Result(rule.id, name, Verdict.PASS, reason, evidence, source)


Run = Callable[[Case], None]


Applies = Callable[[Table, Command], bool]


@dataclass(frozen=True, slots=True)
class Trial:
    """``applies`` picks the commands; without it the trial is of the line as a whole, once.

    ``leave`` is what it needs beside the leave for the command's safety class.
    """

    name: str
    rules: tuple[Rule, ...]
    run: Run
    applies: Applies | None
    leave: frozenset[str]

    def needs(self, command: Command | None) -> frozenset[str]:
        """The leave that it needs for a command."""
        return self.leave | (class_of(command) if command else frozenset())


TRIALS: list[Trial] = []


def trial(*rules: Rule, of: Applies | None, leave: tuple[str, ...] = ()) -> Callable[[Run], Run]:
    """Register a function as a trial that judges by ``rules``; see :class:`Trial`."""

    def register(run: Run) -> Run:
        TRIALS.append(Trial(run.__name__, rules, run, of, frozenset(leave)))
        return run

    return register
