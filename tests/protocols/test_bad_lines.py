"""Faults, recordings and replays of formats with wide ids and LEN, and of replies without an id."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire.capture import read
from cobotwire.protocol.errors import LinkError, ProtocolError, ReplyTimeout
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.faults import KINDS, Fault, Late, Scenario, WrongId, derived, load
from cobotwire.simulator.memory import MemoryTransport

CALLS: dict[str, list[tuple[str, tuple[Any, ...]]]] = {
    "feetech": [("ping", ()), ("read_position", ()), ("write_goal", (1, 2, 3)), ("read_all", ())],
    "ublox": [("get_version", ()), ("get_position", ()), ("get_rate", ())],
}


def talk(protocol: Any, name: str, *faults: Fault, **options: Any) -> list[Any]:
    """Call each method twice on a faulty device; return the results and errors."""
    clock, codec = SteppedClock(), codecs.load(protocol.TABLE)
    arm = SimulatedArm(protocol.TABLE, clock=clock)
    peer = Scenario(name="bad", faults=faults).wrap(arm, codec, clock=clock)
    return _results(protocol, name, peer, clock, **options)


def _results(protocol: Any, name: str, peer: Any, clock: SteppedClock, **options: Any) -> list[Any]:
    found: list[Any] = []
    with protocol.CLIENT(MemoryTransport(peer, clock), **options) as device:
        for method, arguments in CALLS[name] * 2:
            try:
                found.append(getattr(device, method)(*arguments))
            except (ReplyTimeout, ProtocolError, LinkError) as error:
                found.append(error)
    return found


@pytest.mark.parametrize("name", CALLS)
def test_faulty_line_gives_the_right_value_or_an_error(
    package: Callable[[str], Any], name: str
) -> None:
    protocol = package(name)
    right = talk(protocol, name)
    assert not any(isinstance(value, Exception) for value in right)
    # A servo packet is a legal frame of Feetech's own bus.
    kinds = {word: kind for word, kind in KINDS.items() if name == "ublox" or word != "servo-leak"}
    for word, kind in kinds.items():
        found = talk(protocol, name, kind(every=2))
        for value, expected in zip(found, right, strict=True):
            assert value == expected or isinstance(value, Exception), word


def test_fault_wrong_id_does_not_change_replies_without_an_id(
    package: Callable[[str], Any],
) -> None:
    feetech = package("feetech")
    right = talk(feetech, "feetech")
    assert talk(feetech, "feetech", WrongId()) == right
    found = talk(package("ublox"), "ublox", WrongId())
    assert all(isinstance(value, ReplyTimeout) for value in found)


@pytest.mark.parametrize("name", CALLS)
def test_recording_is_decoded_replayed_and_turned_into_faults(
    tmp_path: Path, package: Callable[[str], Any], name: str
) -> None:
    protocol, path = package(name), tmp_path / "a.pcapng"
    late = Late(seconds=0.02, nth=(2,))
    right = talk(protocol, name, late, record=path)
    codec = codecs.load(protocol.TABLE)
    with read(path) as capture:
        packets = list(capture)
    assert all(packet.kind == "frame" for packet in packets)
    sent = [codec.decode("request", p.data) for p in packets if p.direction == "sent"]
    assert [message.command.name for message in sent] == [method for method, _ in CALLS[name]] * 2
    scenario = derived(packets, codec)
    assert max(fault.seconds for fault in scenario.faults if isinstance(fault, Late)) >= 0.02
    (tmp_path / "a.yaml").write_text("replay: a.pcapng")
    clock = SteppedClock()
    arm = SimulatedArm(protocol.TABLE, clock=clock)
    peer = load(tmp_path / "a.yaml").wrap(arm, codec, clock=clock)
    assert _results(protocol, name, peer, clock) == right
