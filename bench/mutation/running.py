"""Runs suites on some processes: every mutant once, and the right subject as often as asked."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from random import Random
from typing import NamedTuple

from mutation.suite import Case, Outcome, Suite, Trial
from mutation.suites import SUITES

# Mutants that a process takes at a time: few, so that both end together.
CHUNK = 8


class Verdicts(NamedTuple):
    """What a tester said of its suite."""

    name: str
    outcomes: list[Outcome]
    trials: list[Trial]

    @property
    def sound(self) -> bool:
        """Whether every mutant is found or excused, and every right subject accepted."""
        found = all(outcome.killed_by or outcome.reason for outcome in self.outcomes)
        return found and all(trial.passed for trial in self.trials)


class _Task(NamedTuple):
    suite: int
    case: Case


class _Right(NamedTuple):
    suite: int
    trial: str


def run(suites: Sequence[int], processes: int, sample: int | None, seed: int) -> Iterator[Verdicts]:
    """Run suites by their place in ``SUITES``; of each kind at most ``sample`` mutants."""
    with ProcessPoolExecutor(processes) as pool:
        for place in suites:
            suite = _suite(place)
            cases = sampled(suite.cases(), sample, seed)
            tasks = [_Task(place, case) for case in cases]
            rights = [_Right(place, name) for name in suite.trials()]
            if sample is not None:
                rights = rights[:: max(1, len(rights) // 2)]
            trials = list(pool.map(_accept, rights, chunksize=1))
            outcomes = list(pool.map(_judge, tasks, chunksize=CHUNK))
            yield Verdicts(suite.name, outcomes, trials)


def sampled(cases: Sequence[Case], most: int | None, seed: int) -> list[Case]:
    """At most so many cases of each kind, drawn with a seed; all of them if ``most`` is None."""
    if most is None:
        return list(cases)
    random = Random(seed)  # noqa: S311  (a draw that can be repeated, not a secret)
    kinds = dict.fromkeys(case.kind for case in cases)
    chosen = {
        case
        for kind in kinds
        for case in _some([case for case in cases if case.kind == kind], most, random)
    }
    return [case for case in cases if case in chosen]


def _some(cases: list[Case], most: int, random: Random) -> list[Case]:
    return random.sample(cases, min(most, len(cases)))


@cache
def _suite(place: int) -> Suite:
    return SUITES[place]()


def _judge(task: _Task) -> Outcome:
    return _suite(task.suite).judge(task.case)


def _accept(right: _Right) -> Trial:
    return _suite(right.suite).accept(right.trial)
