"""Run suites in several processes: each mutant once, and each run on a correct subject."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from random import Random
from typing import NamedTuple

from cobotwire import editions
from cobotwire.protocol.table import Table
from mutation.client.suite import ClientSuite, ScriptlessSuite
from mutation.codec.suite import CodecSuite
from mutation.device.suite import DeviceSuite
from mutation.suite import Outcome, RightRun, Suite, missed

TESTERS: dict[str, Callable[[Table], Suite]] = {
    "device": DeviceSuite,
    "client with a script": ClientSuite,
    "client without a script": ScriptlessSuite,
    "codec": CodecSuite,
}
# Without a script, the referee checks only whether requests are legal: one edition is enough.
WITHOUT_SCRIPT = "mycobot280"
# Mutants per task: few, so that all processes end at about the same time.
CHUNK = 8


class Key(NamedTuple):
    """The names of a tester and an edition, which make a suite."""

    tester: str
    edition: str

    def __str__(self) -> str:
        return f"{self.tester}, {self.edition}"


# The suites that `make conform` runs: up to four for each edition.
SUITES = tuple(
    Key(tester, edition)
    for edition in editions.names()
    for tester in TESTERS
    if tester != "client without a script" or edition == WITHOUT_SCRIPT
)


class Verdicts(NamedTuple):
    """The outcomes of a suite."""

    suite: Key
    outcomes: list[Outcome]
    right_runs: list[RightRun]

    @property
    def sound(self) -> bool:
        """Whether every mutant is killed or excused, and every correct subject passed."""
        return not missed(self.outcomes) and not any(run.failure for run in self.right_runs)


def run(
    suites: Sequence[Key], processes: int, sample: int | None = None, seed: int = 1
) -> Iterator[Verdicts]:
    """Run suites, with at most ``sample`` mutants of each kind."""
    with ProcessPoolExecutor(processes) as pool:
        for key in suites:
            suite = made(key)
            tasks = [(key, id) for id in sampled(suite, sample, seed)]
            rights = [(key, name) for name in suite.right_runs]
            if sample is not None:
                rights = rights[:: max(1, len(rights) // 2)]
            right_runs = list(pool.map(_accepted, rights, chunksize=1))
            yield Verdicts(key, list(pool.map(_outcome, tasks, chunksize=CHUNK)), right_runs)


def sampled(suite: Suite, most: int | None, seed: int) -> list[str]:
    """Return the ids of at most ``most`` mutants of each kind, drawn with a seed; None: all."""
    if most is None:
        return list(suite.mutants)
    random = Random(seed)
    kinds: dict[str, list[str]] = {}
    for mutant in suite.mutants.values():
        kinds.setdefault(mutant.kind, []).append(mutant.id)
    chosen = {id for ids in kinds.values() for id in random.sample(ids, min(most, len(ids)))}
    return [id for id in suite.mutants if id in chosen]


@cache
def made(key: Key) -> Suite:
    """Return a suite, made once in each process."""
    return TESTERS[key.tester](editions.load(key.edition).TABLE)


def _outcome(task: tuple[Key, str]) -> Outcome:
    key, id = task
    return made(key).outcome(id)


def _accepted(task: tuple[Key, str]) -> RightRun:
    key, name = task
    return RightRun(name, made(key).failure(name))
