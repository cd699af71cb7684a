"""The suites that `make conform` runs: up to three testers for each edition."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from cobotwire import editions
from cobotwire.protocol.table import Table
from mutation.client.suite import ClientSuite
from mutation.codec.suite import CodecSuite
from mutation.device.suite import DeviceSuite
from mutation.suite import Suite

# Without a script, the referee judges only whether requests are legal: one edition shows that.
WITHOUT_SCRIPT = "mycobot280"


def _make(kind: Callable[[Table], Suite], edition: str) -> Suite:
    return kind(editions.load(edition).TABLE)


def _suites() -> Iterator[tuple[str, Callable[[], Suite]]]:
    with_script = partial(ClientSuite, with_script=True)
    for edition in editions.names():
        yield f"device, {edition}", partial(_make, DeviceSuite, edition)
        yield f"client with a script, {edition}", partial(_make, with_script, edition)
        if edition == WITHOUT_SCRIPT:
            without = partial(ClientSuite, with_script=False)
            yield f"client without a script, {edition}", partial(_make, without, edition)
        yield f"codec, {edition}", partial(_make, CodecSuite, edition)


# What makes each suite, and its name, in the order of a run.
_EVERY = tuple(_suites())
NAMES = tuple(name for name, _ in _EVERY)
SUITES: tuple[Callable[[], Suite], ...] = tuple(make for _, make in _EVERY)
