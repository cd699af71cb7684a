"""The right device conforms: each time, with everything allowed, and on a line with noise."""

from __future__ import annotations

from random import Random

import pytest

from cobotwire import editions
from cobotwire.conformance import Verdict
from cobotwire.sim import SimulatedArm
from cobotwire.sim.clock import SteppedClock
from conformance.device.testing import Altered, bad, leave, prepared, settings_of

EDITIONS = ["mycobot", "mycobot280"]
# The field notes' servo packets, and lines of the firmware's text.
LEAKS = [
    bytes.fromhex("FF FF 01 04 02 38 02 BE"),
    bytes.fromhex("FF FF 01 04 00 FF 07 F4"),
    bytes.fromhex("FF FF FE 0A 82 38 0F 01 02 03 04 05 06 19"),
    bytes.fromhex("FF FF 07 02 01 F5"),
    b"\0\0\0",
    b"cmd_len error\r\n",
    b"wifi: connecting\r\n",
]


@pytest.mark.parametrize("edition", EDITIONS)
def test_the_simulated_arm_conforms_with_everything_allowed(edition: str) -> None:
    report = prepared(editions.load(edition).TABLE).run()
    assert [r for r in report.results if r.verdict is not Verdict.PASS] == []
    assert report.conforms


# `make conform` runs twenty of twenty for each edition.
@pytest.mark.parametrize(("edition", "seed"), [(EDITIONS[seed % 2], seed) for seed in range(6)])
def test_it_conforms_under_light_noise_each_time(edition: str, seed: int) -> None:
    random = Random(seed)

    def leak() -> bytes:
        return random.choice(LEAKS) if random.randrange(12) == 0 else b""

    under_test = prepared(
        editions.load(edition).TABLE,
        lambda arm: Altered(arm, lambda request, answer, count: leak() + answer + leak()),
    )
    assert bad(under_test.run()) == []
    assert under_test.bench.noise["servo"] > 0


def test_an_arm_that_never_acknowledges_conforms() -> None:
    table = editions.load("mycobot280").TABLE
    open_loop = prepared(table, lambda arm: SimulatedArm(table, clock=arm._clock, acks=False))
    assert isinstance(open_loop.line.clock, SteppedClock)
    assert bad(open_loop.run()) == []


@pytest.mark.parametrize("edition", EDITIONS)
def test_a_run_leaves_the_arm_as_it_was(edition: str) -> None:
    kept = []

    def keep(arm: SimulatedArm) -> SimulatedArm:
        kept.append((arm, settings_of(arm)))
        return arm

    # What is irreversible is not set back, by its name.
    allowed = leave("setting", "persistent-write", "power", "motion", "malformed")
    prepared(editions.load(edition).TABLE, keep, leave=allowed).run()
    [(arm, before)] = kept
    assert settings_of(arm) == before
