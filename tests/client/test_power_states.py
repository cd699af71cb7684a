"""No client counts a reported emergency stop as power, in any edition."""

from __future__ import annotations

from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire.codec import CodecName
from cobotwire.editions import load, names
from cobotwire.protocol.errors import ArmState
from cobotwire.simulator import MemoryTransport, SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from memory_peer import MemoryPeer

OFF, ON, EMERGENCY_STOP = range(3)
TABLES = [load(name).TABLE for name in names()]
WITH_STATES = [
    table
    for table in TABLES
    if (query := table.find_role("powered")) is not None and query.reply[0].fields[0].labels
]


def client_of(table: Any, codec: CodecName, state: int) -> Any:
    """Return a client of an arm whose power is in a state."""
    frame = codecs.load(table).encode("is_power_on", "reply", (state,))
    transport = MemoryTransport(MemoryPeer(frame), SteppedClock())
    return load(table.edition).CLIENT(transport, codec=codec)


def test_editions_with_states_are_those_of_mercury_and_pro() -> None:
    assert [table.edition for table in WITH_STATES] == [
        *("mercury_a1", "mercury_b1", "mercury_x1", "pro400", "pro450", "pro630")
    ]


@pytest.mark.parametrize("codec", ["reference", "native"])
@pytest.mark.parametrize("table", WITH_STATES, ids=lambda table: table.edition)
def test_only_an_arm_with_power_counts_as_true(table: Any, codec: CodecName) -> None:
    states = [client_of(table, codec, state).is_power_on() for state in range(3)]
    assert [state.name for state in states] == ["OFF", "ON", "EMERGENCY_STOP"]
    assert [int(state) for state in states] == [OFF, ON, EMERGENCY_STOP]
    assert [bool(state) for state in states] == [False, True, False]


@pytest.mark.parametrize("table", WITH_STATES, ids=lambda table: table.edition)
def test_failed_motion_names_the_emergency_stop(table: Any) -> None:
    powered = client_of(table, "reference", EMERGENCY_STOP).is_power_on()
    assert ArmState(powered=powered).sentences() == ["it has no power: it reports EMERGENCY_STOP"]
    powered = client_of(table, "reference", OFF).is_power_on()
    assert ArmState(powered=powered).sentences() == ["it has no power"]


@pytest.mark.parametrize("table", WITH_STATES, ids=lambda table: table.edition)
def test_simulated_arm_reports_its_power(table: Any) -> None:
    arm = SimulatedArm(table, clock=SteppedClock(), powered=True)
    client: Any = load(table.edition).CLIENT(MemoryTransport(arm, SteppedClock()))
    assert client.is_power_on().name == "ON"
    arm.state.powered = False
    assert client.is_power_on().name == "OFF"
