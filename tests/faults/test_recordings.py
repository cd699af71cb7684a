"""Recordings as scenarios: replayed as they were, or turned into faults for any arm."""

from __future__ import annotations

from pathlib import Path

import pytest

from cobotwire.capture import CaptureReader, Packet, Recording, read
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.errors import CaptureError, UsageError
from cobotwire.sim import SimulatedArm
from cobotwire.sim.clock import SteppedClock
from cobotwire.sim.faults import Inserted, Late, Lost, Split, derived, load
from faulty_talk import CODEC, GET_ANGLES, IS_POWERED, OFF, ZEROS, pass_time, talk

PING = bytes.fromhex("FF FF 07 02 01 F5")
ON = bytes.fromhex("FE FE 03 12 01 FA")
# Seconds, direction, bytes: two questions that are answered in their way, and one that is not.
LINE = [
    (0.0, "sent", IS_POWERED),
    (0.25, "heard", PING),
    (0.5, "heard", ON[:2]),
    (0.75, "heard", ON[2:]),
    (1.0, "sent", GET_ANGLES),
    (2.0, "sent", IS_POWERED),
    (2.0, "heard", ON),
]


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    path = tmp_path / "monday.pcapng"
    recorded = Recording(path, CODEC)
    for at, direction, data in LINE:
        assert direction in ("sent", "heard")
        recorded.record("sent" if direction == "sent" else "heard", data, at)
    recorded.close()
    return path


def _packets(path: Path) -> list[Packet]:
    with read(path) as capture:
        assert isinstance(capture, CaptureReader)
        return list(capture)


def test_a_scenario_replays_a_recording_that_lies_beside_it(recording: Path) -> None:
    file = recording.with_name("monday.yaml")
    file.write_text("{replay: monday.pcapng, speed: 2, faults: [{fault: doubled, nth: 2}]}")
    clock = SteppedClock()
    peer = load(file).wrap(SimulatedArm(TABLE), CODEC, clock=clock)
    heard: list[tuple[float, bytes]] = []
    assert peer.receive(IS_POWERED) == b""
    pass_time(peer, clock, 1.0, heard)
    assert [data for _, data in heard] == [PING, ON[:2], ON[2:]]
    assert [at for at, _ in heard] == pytest.approx([0.125, 0.25, 0.375])
    peer.receive(GET_ANGLES)
    pass_time(peer, clock, 1.0, heard)
    assert len(heard) == 3, "it was not answered then either"


def test_a_recording_that_is_none_is_refused(tmp_path: Path) -> None:
    (tmp_path / "noise.pcapng").write_bytes(b"no capture at all")
    (tmp_path / "a.yaml").write_text("replay: noise.pcapng")
    with pytest.raises(CaptureError):
        load(tmp_path / "a.yaml").wrap(SimulatedArm(TABLE), CODEC)


def test_what_went_wrong_becomes_faults(recording: Path) -> None:
    scenario = derived(_packets(recording), CODEC)
    *faults, last = scenario.faults
    assert isinstance(last, Late)
    assert (last.commands, last.nth) == ((0x12,), (2,))
    assert last.seconds == pytest.approx(0, abs=1e-6)
    assert [type(fault) for fault in faults] == [Split, Inserted, Late, Lost]
    assert {(fault.commands, fault.nth) for fault in faults[:3]} == {((0x12,), (1,))}


def test_they_are_done_to_another_arm(recording: Path) -> None:
    faults = derived(_packets(recording), CODEC).faults
    played = talk(faults, [IS_POWERED, 1.0, GET_ANGLES, 1.0, IS_POWERED, 1.0, GET_ANGLES])
    # The second get_angles was not recorded: it meets nothing.
    assert [data for _, data in played.heard] == [PING + OFF[:2], OFF[2:], OFF, ZEROS]
    assert [at for at, _ in played.heard] == pytest.approx([0.5, 0.75, 2.0, 3.0], abs=1e-6)


def test_a_recording_in_which_nothing_is_sent_gives_nothing() -> None:
    with pytest.raises(UsageError, match="something is sent"):
        derived([], CODEC)
