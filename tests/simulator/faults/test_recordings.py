"""Test recordings as scenarios: replayed, or turned into faults for any arm."""

from __future__ import annotations

from pathlib import Path

import pytest

from cobotwire.capture import CaptureReader, Packet, Recording, read
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.protocol.errors import CaptureError, UsageError
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.faults import Inserted, Late, Lost, Split, derived, load
from faulty_talk import CODEC, GET_ANGLES, IS_POWERED, OFF, ZEROS, talk
from playing import play

PING = bytes.fromhex("FF FF 07 02 01 F5")
ON = bytes.fromhex("FE FE 03 12 01 FA")
# Seconds, direction, bytes: two requests with a reply, and one without.
LINE = [
    (0.0, "sent", IS_POWERED),
    (0.25, "received", PING),
    (0.5, "received", ON[:2]),
    (0.75, "received", ON[2:]),
    (1.0, "sent", GET_ANGLES),
    (2.0, "sent", IS_POWERED),
    (2.0, "received", ON),
]


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    path = tmp_path / "monday.pcapng"
    recorded = Recording(path, CODEC)
    for at, direction, data in LINE:
        assert direction in ("sent", "received")
        recorded.record("sent" if direction == "sent" else "received", data, at)
    recorded.close()
    return path


def _packets(path: Path) -> list[Packet]:
    with read(path) as capture:
        assert isinstance(capture, CaptureReader)
        return list(capture)


def test_scenario_replays_a_recording_beside_its_file(recording: Path) -> None:
    file = recording.with_name("monday.yaml")
    file.write_text("{replay: monday.pcapng, speed: 2, faults: [{fault: duplicated, nth: 2}]}")
    clock = SteppedClock()
    peer = load(file).wrap(SimulatedArm(TABLE), CODEC, clock=clock)
    received = play(peer, clock, [(0.0, IS_POWERED), (1.0, b"")])
    assert [data for _, data in received] == [PING, ON[:2], ON[2:]]
    assert [at for at, _ in received] == pytest.approx([0.125, 0.25, 0.375])
    # This request has no recorded reply.
    assert play(peer, clock, [(0.0, GET_ANGLES), (1.0, b"")]) == []


def test_file_that_is_not_a_recording_is_rejected(tmp_path: Path) -> None:
    (tmp_path / "noise.pcapng").write_bytes(b"no capture at all")
    (tmp_path / "a.yaml").write_text("replay: noise.pcapng")
    with pytest.raises(CaptureError):
        load(tmp_path / "a.yaml").wrap(SimulatedArm(TABLE), CODEC)


def test_derived_scenario_has_the_faults_of_a_recording(recording: Path) -> None:
    scenario = derived(_packets(recording), CODEC)
    *faults, last = scenario.faults
    assert isinstance(last, Late)
    assert (last.commands, last.nth) == ((0x12,), (2,))
    assert last.seconds == pytest.approx(0, abs=1e-6)
    assert [type(fault) for fault in faults] == [Split, Inserted, Late, Lost]
    assert {(fault.commands, fault.nth) for fault in faults[:3]} == {((0x12,), (1,))}


def test_derived_faults_apply_to_another_arm(recording: Path) -> None:
    faults = derived(_packets(recording), CODEC).faults
    played = talk(faults, [IS_POWERED, 1.0, GET_ANGLES, 1.0, IS_POWERED, 1.0, GET_ANGLES])
    # The second get_angles was not recorded, so no fault applies to it.
    assert [data for _, data in played.received] == [PING + OFF[:2], OFF[2:], OFF, ZEROS]
    assert [at for at, _ in played.received] == pytest.approx([0.5, 0.75, 2.0, 3.0], abs=1e-6)


def test_recording_without_requests_is_rejected() -> None:
    with pytest.raises(UsageError, match="contains no request"):
        derived([], CODEC)
