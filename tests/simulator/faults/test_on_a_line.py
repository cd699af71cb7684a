"""Test shipped scenarios on a real pty with our client, and the diagnosis of the traffic."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from typing import NamedTuple

import pytest

from cobotwire import CobotwireError, ReplyTimeout
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.diagnose import Finding, summarize
from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.simulator import PtyServer, SimulatedArm
from cobotwire.simulator.faults import AppliedFault, Scenario, find
from cobotwire.transport import TappedTransport, open_transport
from diagnosing import diagnose


class Session:
    """Our client on a faulty arm, and its traffic."""

    def __init__(
        self,
        arm: MyCobot280,
        transport: TappedTransport,
        simulated: SimulatedArm,
        done: list[AppliedFault],
    ) -> None:
        self.arm = arm
        self.transport = transport
        self.simulated = simulated
        self.received = b""
        self.sent = b""
        self.done = done

    def note(self, direction: str, data: bytes, at: float) -> None:
        if direction == "received":
            self.received += data
        else:
            self.sent += data

    def send_requests(self, times: int) -> int:
        """Send ``times`` requests; return how many got a reply, and fail on a wrong one."""
        right = 0
        for _ in range(times):
            with suppress(CobotwireError):
                assert tuple(self.arm.get_angles()) == (0.0,) * 6
                right += 1
        return right

    def findings(self, codec: Codec) -> list[Finding]:
        items = diagnose(codec, self.received, sent=self.sent)
        return [item for item in items if isinstance(item, Finding)]


@contextmanager
def session(scenario: Scenario) -> Iterator[Session]:
    codec = codecs.load(TABLE)
    simulated = SimulatedArm(TABLE)
    done: list[AppliedFault] = []
    peer = scenario.wrap(simulated, codec, on_fault=done.append)
    with PtyServer(peer) as port:
        taps: list[Session] = []

        def tap(direction: str, data: bytes, at: float) -> None:
            taps[0].note(direction, data, at)

        transport = TappedTransport(open_transport(port.url, TABLE.baudrate), tap)
        with MyCobot280(transport) as arm:
            started = Session(arm, transport, simulated, done)
            taps.append(started)
            yield started


class Expected(NamedTuple):
    """What a scenario causes.

    Attributes:
        requests: how many requests.
        right: how many of them get a reply.
        kinds: what noise there must be.
        also: what may come with it, where the bytes of a broken frame are ambiguous.
    """

    requests: int
    right: int
    kinds: set[str]
    also: frozenset[str] = frozenset()


SEED_OF_A_HIGH_BIT = 6
BROKEN = frozenset({"nuls", "unrecognised", "text"})
SHOWN = {
    "servo-leaks": Expected(4, 4, {"servo"}),
    "servo-leak-inside": Expected(3, 3, {"servo", "damaged-frame"}, BROKEN),
    "servo-checksum-fe": Expected(2, 2, {"servo"}),
    "command-errors": Expected(2, 2, {"cmd-len-error"}),
    "nuls": Expected(3, 3, {"nuls"}),
    "panic": Expected(6, 5, {"damaged-frame", "panic", "nuls", "garbage"}, BROKEN),
    "wrong-baud": Expected(1, 0, {"garbage"}, BROKEN),
    "echo": Expected(2, 2, {"opposite-frame"}),
    "corrupted-footers": Expected(3, 3, {"damaged-frame"}, BROKEN),
    "wrong-length": Expected(3, 3, {"damaged-frame"}, BROKEN),
    "merged-replies": Expected(2, 2, set()),
    "stray-acks": Expected(2, 2, set()),
    "other-frame-before-reply": Expected(2, 2, set()),
    "pause-in-reply": Expected(2, 2, set()),
    "pause-after-header": Expected(2, 2, set()),
    "slow-line": Expected(2, 2, set()),
    "usb-latency-timer": Expected(2, 2, set()),
    "duplicated-replies": Expected(2, 2, set()),
    "held-in-reset": Expected(1, 0, set()),
}


@pytest.mark.parametrize("name", SHOWN)
def test_diagnosis_recognises_the_fault_of_a_scenario(name: str) -> None:
    expected = SHOWN[name]
    with session(find(name, TABLE)) as played:
        assert played.send_requests(expected.requests) == expected.right
    findings = played.findings(codecs.load(TABLE))
    kinds = {finding.kind for finding in findings}
    assert expected.kinds <= kinds <= expected.kinds | expected.also, summarize(findings)
    assert played.done


def test_damaged_request_is_obeyed() -> None:
    # With this seed the changed bit moves the joint by a tick or more; a hundredth would not.
    with session(replace(find("damaged-requests", TABLE), seed=SEED_OF_A_HIGH_BIT)) as played:
        played.arm.power_on()
        played.arm.send_angles([0, 0, 0, 0, 0, 0], speed=100)
        assert played.arm.get_angles() is not None
        assert [done.fault for done in played.done] == ["corrupted"]
        assert abs(played.simulated.state.angles.target(time.monotonic())[0]) > 0.2


def test_line_that_an_xoff_stops_continues_afterwards() -> None:
    with session(find("flow-control", TABLE)) as played:
        played.arm.power_on()
        # The tick at 15.56 degrees reads as 0x0613. The way there takes 0.56 s.
        played.arm.send_angles([15.56, 0, 0, 0, 0, 0], speed=100)
        time.sleep(1.0)
        with pytest.raises(ReplyTimeout):
            played.arm.get_angles()
        time.sleep(1.2)
        assert played.arm.is_power_on() is True
    assert "the host is stopped for 1 s" in played.done[0].detail
