"""A correct device conforms on a line with noise, and has its settings back after a run."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.faults import AppliedFault
from cobotwire.simulator.peer import Peer
from cobotwire.simulator.state import ArmState
from conformance.device.testing import permissions, prepared, settings_of
from mutation.device.suite import LIGHT_NOISE


# `make conform` runs twenty seeds for each edition, and all must pass.
@pytest.mark.parametrize(
    ("edition", "seed", "acks"), [("mycobot", 0, True), ("mycobot280", 1, False)]
)
def test_simulated_arm_conforms_with_light_noise_also_without_acks(
    edition: str, seed: int, acks: bool
) -> None:
    applied: list[AppliedFault] = []

    def noisy(arm: SimulatedArm) -> Peer:
        codec = codecs.load(arm.table)
        arm = SimulatedArm(arm.table, clock=arm.clock, acks=acks)
        return LIGHT_NOISE.wrap(arm, codec, clock=arm.clock, seed=1, on_fault=applied.append)

    assert prepared(editions.load(edition).TABLE, noisy).run().failures == []
    assert len(applied) > 20


def test_run_restores_what_it_changes() -> None:
    kept = []

    def keep(arm: SimulatedArm) -> SimulatedArm:
        kept.append((arm, settings_of(arm)))
        return arm

    # What is irreversible cannot be restored.
    allowed = permissions("setting", "persistent-write", "power", "motion", "malformed")
    prepared(editions.load("mycobot280").TABLE, keep, permissions=allowed).run()
    [(arm, before)] = kept
    assert settings_of(arm) == before


# A change of each kind of value: plain, in a row, in a dict of a list, in a dict of a dict.
CHANGES: list[Callable[[ArmState], object]] = [
    lambda state: state.kept.update(fresh_mode=1 - state.kept["fresh_mode"]),
    lambda state: state.kept.update(tool=(*state.kept["tool"][:5], 0.1)),
    lambda state: state.minimum.append(state.minimum.pop() + 0.1),
    lambda state: state.kept["registers"].update({(4, 21): 11}),
    lambda state: state.kept["pins"].update({(5,): True}),
    lambda state: state.backups.update({1: {20: 1}}),
]


@pytest.mark.parametrize("change", CHANGES)
def test_changed_value_of_a_setting_is_noticed(change: Callable[[ArmState], object]) -> None:
    arm = SimulatedArm(editions.load("mycobot280").TABLE)
    before = settings_of(arm)
    assert settings_of(arm) == before
    change(arm.state)
    assert settings_of(arm) != before
