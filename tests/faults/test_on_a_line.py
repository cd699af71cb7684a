"""Shipped scenarios on a real pty, with our client; what came over the line is diagnosed."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import NamedTuple

import pytest

from cobotwire import CobotwireError, LinkError, ReplyTimeout
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.diagnose import Finding, summary
from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.sim import PtyPort, SimulatedArm
from cobotwire.sim.faults import Done, Scenario, find
from cobotwire.transport import TappedLink, open_link
from diagnosing import diagnose


class Session:
    """Our client on a faulty arm, and all that came over its line."""

    def __init__(
        self, arm: MyCobot280, link: TappedLink, simulated: SimulatedArm, done: list[Done]
    ) -> None:
        self.arm = arm
        self.link = link
        self.simulated = simulated
        self.heard = b""
        self.sent = b""
        self.done = done

    def note(self, direction: str, data: bytes, at: float) -> None:
        if direction == "heard":
            self.heard += data
        else:
            self.sent += data

    def ask(self, times: int) -> int:
        """How many of so many questions are answered; a wrong answer is a failure."""
        right = 0
        for _ in range(times):
            with suppress(CobotwireError):
                assert tuple(self.arm.get_angles()) == (0.0,) * 6
                right += 1
        return right

    def findings(self, codec: Codec) -> list[Finding]:
        items = diagnose(codec, self.heard, sent=self.sent)
        return [item for item in items if isinstance(item, Finding)]


@contextmanager
def session(scenario: Scenario) -> Iterator[Session]:
    codec = codecs.load(TABLE)
    simulated = SimulatedArm(TABLE)
    done: list[Done] = []
    peer = scenario.wrap(simulated, codec, watch=done.append)
    with PtyPort(peer) as port:
        taps: list[Session] = []

        def tap(direction: str, data: bytes, at: float) -> None:
            taps[0].note(direction, data, at)

        link = TappedLink(open_link(port.url, TABLE.baudrate), tap)
        with MyCobot280(link) as arm:
            started = Session(arm, link, simulated, done)
            taps.append(started)
            yield started


class Expected(NamedTuple):
    """How a scenario shows.

    Attributes:
        asked: how many questions.
        right: how many of them are answered.
        kinds: what noise there must be.
        also: what may come with it, where a broken frame's bytes say nothing.
    """

    asked: int
    right: int
    kinds: set[str]
    also: frozenset[str] = frozenset()


BROKEN = frozenset({"nuls", "unrecognised", "text"})
SHOWN = {
    "servo-leaks": Expected(4, 4, {"servo"}),
    "servo-leak-inside": Expected(3, 3, {"servo", "damaged-frame"}, BROKEN),
    "servo-checksum-fe": Expected(2, 2, {"servo"}),
    "command-errors": Expected(2, 2, {"cmd-len-error"}),
    "nuls": Expected(3, 3, {"nuls"}),
    "panic": Expected(6, 5, {"damaged-frame", "panic", "nuls", "garbage"}, BROKEN),
    "wrong-baud": Expected(1, 0, {"garbage"}, BROKEN),
    "echo": Expected(2, 2, {"other-way"}),
    "corrupted-footers": Expected(3, 3, {"damaged-frame"}, BROKEN),
    "wrong-length": Expected(3, 3, {"damaged-frame"}, BROKEN),
    "merged-replies": Expected(2, 2, set()),
    "stray-acks": Expected(2, 2, set()),
    "other-frame-in-front": Expected(2, 2, set()),
    "pause-in-reply": Expected(2, 2, set()),
    "pause-behind-header": Expected(2, 2, set()),
    "slow-line": Expected(2, 2, set()),
    "usb-latency-timer": Expected(2, 2, set()),
    "doubled-replies": Expected(2, 2, set()),
    "held-in-reset": Expected(1, 0, set()),
}


@pytest.mark.parametrize("name", SHOWN)
def test_a_fault_is_recognised_as_what_it_is(name: str) -> None:
    expected = SHOWN[name]
    with session(find(name, TABLE)) as played:
        assert played.ask(expected.asked) == expected.right
    findings = played.findings(codecs.load(TABLE))
    kinds = {finding.kind for finding in findings}
    assert expected.kinds <= kinds <= expected.kinds | expected.also, summary(findings)
    assert played.done


def test_a_panic_is_a_reboot_and_the_arm_has_lost_its_state() -> None:
    with session(find("panic", TABLE)) as played:
        played.arm.power_on()
        assert played.arm.is_power_on() is True
        played.ask(4)
        assert played.arm.is_power_on() is False
    said = summary(played.findings(codecs.load(TABLE)))
    assert said.startswith("the controller rebooted: panic LoadProhibited")


def test_a_damaged_order_is_obeyed() -> None:
    with session(find("damaged-orders", TABLE)) as played:
        played.arm.power_on()
        played.arm.send_angles([0, 0, 0, 0, 0, 0], speed=100)
        assert played.arm.get_angles() is not None
        assert [done.fault for done in played.done] == ["corrupted"]
        assert played.simulated.state.angles.target(0.0)[0] != 0


def test_a_line_that_an_xoff_stops_goes_on_afterwards() -> None:
    with session(find("flow-control", TABLE)) as played:
        played.arm.power_on()
        # 0.19 degrees are 0x0013.
        played.arm.send_angles([0.19, 0, 0, 0, 0, 0], speed=100)
        time.sleep(0.1)
        with pytest.raises(ReplyTimeout):
            played.arm.get_angles()
        time.sleep(1.2)
        assert played.arm.is_power_on() is True
    assert "the host is stopped for 1 s" in played.done[0].detail


def test_a_query_that_the_firmware_does_not_know_hangs_it() -> None:
    with session(find("frozen", TABLE)) as played:
        assert played.ask(1) == 1
        played.link.write(bytes.fromhex("FE FE 02 19 FA"))
        assert played.ask(1) == 0


def test_a_port_that_goes_is_a_link_error() -> None:
    with session(find("unplugged", TABLE)) as played:
        assert played.ask(6) == 6
        with pytest.raises(LinkError):
            played.arm.get_angles()
