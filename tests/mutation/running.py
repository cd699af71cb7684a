"""Run suites in several processes: each mutant once, and each run on a correct subject."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from random import Random
from typing import NamedTuple

from mutation.suite import Case, Outcome, RightRun, Suite
from mutation.suites import SUITES

# Mutants per task: few, so that all processes end at about the same time.
CHUNK = 8


class Verdicts(NamedTuple):
    """The outcomes of a suite."""

    name: str
    outcomes: list[Outcome]
    right_runs: list[RightRun]

    @property
    def sound(self) -> bool:
        """Whether every mutant is killed or excused, and every correct subject passed."""
        found = all(outcome.killed_by or outcome.reason for outcome in self.outcomes)
        return found and all(run.passed for run in self.right_runs)


class _Task(NamedTuple):
    suite: int
    case: Case


class _RightTask(NamedTuple):
    suite: int
    run: str


def run(suites: Sequence[int], processes: int, sample: int | None, seed: int) -> Iterator[Verdicts]:
    """Run suites by their index in ``SUITES``, with at most ``sample`` mutants of each kind."""
    with ProcessPoolExecutor(processes) as pool:
        for place in suites:
            suite = _suite(place)
            cases = sampled(suite.cases(), sample, seed)
            tasks = [_Task(place, case) for case in cases]
            rights = [_RightTask(place, name) for name in suite.right_runs()]
            if sample is not None:
                rights = rights[:: max(1, len(rights) // 2)]
            right_runs = list(pool.map(_accept, rights, chunksize=1))
            outcomes = list(pool.map(_judge, tasks, chunksize=CHUNK))
            yield Verdicts(suite.name, outcomes, right_runs)


def sampled(cases: Sequence[Case], most: int | None, seed: int) -> list[Case]:
    """Return at most ``most`` cases of each kind, drawn with a seed; all if it is None."""
    if most is None:
        return list(cases)
    random = Random(seed)
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


def _accept(task: _RightTask) -> RightRun:
    return _suite(task.suite).accept(task.run)
