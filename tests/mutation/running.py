"""Name the suites, draw mutants from one, and run them in several processes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from functools import cache, partial
from random import Random
from typing import NamedTuple

from cobotwire import editions
from cobotwire.protocol.table import Table
from mutation.client.suite import ClientSuite
from mutation.codec.suite import CodecSuite
from mutation.device.suite import DeviceSuite
from mutation.suite import Outcome, Suite

TESTERS: dict[str, Callable[[Table], Suite]] = {
    "device": DeviceSuite,
    "client with a script": ClientSuite,
    "client without a script": partial(ClientSuite, with_script=False),
    "codec": CodecSuite,
}
# Without a script, the referee checks only whether requests are legal: one edition is enough.
WITHOUT_SCRIPT = "mycobot280"


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


def run(key: Key, ids: Iterable[str], processes: int) -> list[Outcome]:
    """Return the outcomes of mutants of a suite; in this process if it is the only one."""
    outcome = partial(_outcome, key)
    if processes == 1:
        return list(map(outcome, ids))
    with ProcessPoolExecutor(processes) as pool:
        # Few mutants for each task, so that all processes end at about the same time.
        return list(pool.map(outcome, ids, chunksize=8))


def _outcome(key: Key, id: str) -> Outcome:
    return made(key).outcome(id)
