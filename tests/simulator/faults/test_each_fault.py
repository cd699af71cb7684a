"""Test what each fault does to a reply, byte by byte, in stepped time."""

from __future__ import annotations

import pytest

from cobotwire.editions.mycobot280 import TABLE
from cobotwire.protocol.errors import UsageError
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.faults import (
    KINDS,
    CommandError,
    Corrupted,
    Dropped,
    Duplicated,
    Echo,
    Fault,
    FlowControl,
    Frozen,
    Inserted,
    Late,
    Lost,
    Merged,
    Noise,
    OtherAddress,
    Panic,
    Replaced,
    Scenario,
    ServoLeak,
    Silent,
    Slow,
    Split,
    Stalled,
    Truncated,
    Unplugged,
    UnrequestedEvent,
    WrongBaud,
    WrongId,
    WrongLength,
    noise,
)
from cobotwire.simulator.peer import PeerDisconnected
from faulty_talk import ACK, CODEC, GET_ANGLES, IS_POWERED, OFF, POWER_ON, ZEROS, talk
from playing import play

TEXT = b"cmd_len error\r\n"
PING = bytes.fromhex("FF FF 07 02 01 F5")
HALF: list[bytes | float] = [IS_POWERED, 0.5, IS_POWERED]

# The fault, the requests, and what arrives when.
PLAYED: list[tuple[Fault, list[bytes | float], list[tuple[float, bytes]]]] = [
    (Late(seconds=0.1), [IS_POWERED], [(0.1, OFF)]),
    # A later reply overtakes it.
    (Late(seconds=0.7, nth=(1,)), [GET_ANGLES, 0.5, IS_POWERED], [(0.5, OFF), (0.7, ZEROS)]),
    (Stalled(seconds=0.7, nth=(1,)), [GET_ANGLES, 0.5, IS_POWERED], [(0.7, ZEROS + OFF)]),
    (Split(after_bytes=2, seconds=0.1), [IS_POWERED], [(0.0, OFF[:2]), (0.1, OFF[2:])]),
    # The reply after a split one waits for the end of the split one.
    (
        Split(after_bytes=2, seconds=1, nth=(1,)),
        HALF,
        [(0.0, OFF[:2]), (1.0, OFF[2:] + OFF)],
    ),
    (
        Slow(bits_per_second=80),
        [IS_POWERED],
        [((n + 1) / 8, OFF[n : n + 1]) for n in range(6)],
    ),
    (Merged(only="acknowledgements"), [POWER_ON, 0.5, GET_ANGLES], [(0.5, ACK + ZEROS)]),
    (Merged(at_most_seconds=0.25), [IS_POWERED], [(0.25, OFF)]),
    (Merged(), [*HALF, IS_POWERED], [(0.5, OFF * 2), (1.5, OFF)]),
    (Lost(nth=(1,)), HALF, [(0.5, OFF)]),
    (Lost(of="request", commands=("power_on",)), [POWER_ON, 0.5, IS_POWERED], [(0.5, OFF)]),
    (Truncated(after_bytes=4), [IS_POWERED], [(0.0, OFF[:4])]),
    (Truncated(after_bytes=3, of="request"), HALF, []),
    (Dropped(byte=2), [IS_POWERED], [(0.0, OFF[:2] + OFF[3:])]),
    (Corrupted(byte=-1, bits=8), [IS_POWERED], [(0.0, OFF[:-1] + b"\x05")]),
    (Corrupted(byte=40), [IS_POWERED], [(0.0, OFF)]),
    (WrongLength(by=-1), [IS_POWERED], [(0.0, b"\xfe\xfe\x02\x12\x00\xfa")]),
    (WrongId(id=0x20), [IS_POWERED], [(0.0, b"\xfe\xfe\x03\x20\x00\xfa")]),
    (Replaced(by=b"\x78\x80\x78"), [IS_POWERED], [(0.0, b"\x78\x80\x78")]),
    (ServoLeak(packets=("ping",)), [IS_POWERED], [(0.0, PING + OFF)]),
    (
        ServoLeak(packets=("ping",), where="inside", after_bytes=4),
        [IS_POWERED],
        [(0.0, OFF[:4] + PING + OFF[4:])],
    ),
    (Noise(classes=("panic",), only="acknowledgements"), [IS_POWERED], [(0.0, OFF)]),
    (Noise(classes=("ack",), where="after"), [IS_POWERED], [(0.0, OFF + ACK)]),
    (Inserted(data=b"\0", times=3, where="after"), [IS_POWERED], [(0.0, OFF + bytes(3))]),
    # The error for malformed input comes once, after a pause, whatever pieces the input comes in.
    (CommandError(), [IS_POWERED[:3], 1.0, IS_POWERED], [(0.2, TEXT), (1.0, OFF)]),
    (CommandError(), [b"abc" + IS_POWERED], [(0.0, TEXT + OFF)]),
    (
        CommandError(only="requests", times=2, seconds=0.25),
        [IS_POWERED],
        [(0.0, TEXT), (0.25, TEXT), (0.5, OFF)],
    ),
    (Inserted(data=b"\x01", where="inside", after_bytes=99), [IS_POWERED], [(0.0, OFF + b"\x01")]),
    (Duplicated(), [IS_POWERED], [(0.0, OFF * 2)]),
    (Duplicated(seconds=0.1), [IS_POWERED], [(0.0, OFF), (0.1, OFF)]),
    (Echo(), [IS_POWERED], [(0.0, IS_POWERED + OFF)]),
    (Echo(seconds=0.1), [IS_POWERED], [(0.0, IS_POWERED), (0.1, OFF)]),
    (Echo(commands=(0xB2,)), [IS_POWERED], [(0.0, OFF)]),
    (
        Silent(nth=(2,), seconds=1),
        [*HALF, 0.5, IS_POWERED, 1.0, IS_POWERED],
        [(0.0, OFF), (2.0, OFF)],
    ),
    # Replies that are not sent yet are lost.
    (Silent(nth=(2,), seconds=0), [IS_POWERED, IS_POWERED], [(0.0, OFF)]),
    (Frozen(commands=(0x19,)), [bytes.fromhex("FE FE 02 19 FA"), 900.0, IS_POWERED], []),
    (FlowControl(), [IS_POWERED], [(0.0, OFF)]),
    # This edition has no events and no addresses; conformance/client/test_other_messages.py has one
    # with both.
    (UnrequestedEvent(), [IS_POWERED], [(0.0, OFF)]),
    (OtherAddress(), [IS_POWERED], [(0.0, OFF)]),
]


@pytest.mark.parametrize(
    ("fault", "requests", "expected"), PLAYED, ids=lambda value: getattr(value, "kind", "")
)
def test_each_fault_produces_these_bytes_at_these_times(
    fault: Fault, requests: list[bytes | float], expected: list[tuple[float, bytes]]
) -> None:
    received = talk([fault], requests).received
    assert [data for _, data in received] == [data for _, data in expected]
    assert [at for at, _ in received] == pytest.approx([at for at, _ in expected])


def test_every_kind_of_fault_has_a_case() -> None:
    played = {fault.kind for fault, _, _ in PLAYED} | {"panic", "unplugged", "wrong-baud"}
    assert played == set(KINDS)


def test_applied_fault_is_reported() -> None:
    (done,) = talk([Late(seconds=0.1, nth=(2,))], [IS_POWERED, 0.5, IS_POWERED]).applied
    assert str(done) == "0.500 s late at is_power_on: 0.100 s late"
    (done,) = talk([Dropped(byte=2)], [IS_POWERED]).applied
    assert (done.detail, done.added) == ("03 missing at byte 2 of the reply", -1)


def test_panic_sends_text_nuls_and_garbage_and_loses_the_state() -> None:
    requests: list[bytes | float] = [
        POWER_ON,
        1.0,
        IS_POWERED,
        1.0,
        IS_POWERED,
        0.1,
        IS_POWERED,
        1.0,
        IS_POWERED,
    ]
    played = talk([Panic(nth=(3,), deaf_seconds=0.5, after_bytes=2)], requests)
    boot = noise.at_other_rate(noise.BOOT, 4)
    assert [(round(at, 3), data) for at, data in played.received] == [
        (0.0, ACK),
        (1.0, b"\xfe\xfe\x03\x12\x01\xfa"),
        (2.0, OFF[:2] + noise.PANIC),
        (2.25, bytes(277)),
        (2.5, boot),
        (3.1, OFF),
    ]
    assert 2300 <= len(noise.PANIC) <= 2500
    assert [done.fault for done in played.applied] == ["panic", "deaf"]


def test_power_cycle_wakes_a_frozen_arm() -> None:
    clock = SteppedClock()
    scenario = Scenario(name="test", faults=(Frozen(nth=(2,)),))
    arm = SimulatedArm(TABLE, clock=clock)
    peer = scenario.wrap(arm, CODEC, clock=clock)
    assert peer.receive(POWER_ON) == ACK
    assert peer.receive(IS_POWERED) == b""
    clock.sleep(1000)
    assert peer.receive(IS_POWERED) == b""
    peer.power_cycle()
    assert peer.receive(IS_POWERED) == OFF


def test_xoff_is_swallowed_and_stops_the_host() -> None:
    # No joint can have an angle of 0x1300 hundredths of a degree, but a register may hold 0x13.
    request = bytes.fromhex("FE FE 04 53 01 13 FA")
    clock = SteppedClock()
    faults = (
        Replaced(commands=(0x53,), by=bytes.fromhex("FE FE 03 53 13 FA")),
        FlowControl(seconds=1),
    )
    peer = Scenario(name="test", faults=faults).wrap(
        SimulatedArm(TABLE, clock=clock), CODEC, clock=clock
    )
    assert peer.receive(request) == bytes.fromhex("FE FE 03 53 FA")
    assert peer.receive(IS_POWERED) == b""
    assert play(peer, clock, [(5.0, b"")]) == [(1.0, OFF)]


def test_wrong_baud_rate_gives_the_garbage_of_the_field_notes() -> None:
    # An ESP32's boot output begins with "ets "; a receiver four times as fast reads these bytes.
    assert noise.at_other_rate(noise.BOOT, 4).startswith(b"\x78\x80\x78")
    assert talk([WrongBaud()], [IS_POWERED]).data == noise.at_other_rate(OFF, 4)


@pytest.mark.parametrize("data", [b"\x00\xff\x55", noise.BOOT, bytes(range(256))])
def test_equal_baud_rates_give_the_bytes_that_were_sent(data: bytes) -> None:
    assert noise.at_other_rate(data, 1) == data


def test_unplugged_port_raises_peer_disconnected() -> None:
    done: list[object] = []
    scenario = Scenario(name="test", faults=(Unplugged(nth=(2,)),))
    peer = scenario.wrap(SimulatedArm(TABLE), CODEC, on_fault=done.append)
    assert peer.receive(IS_POWERED) == OFF
    with pytest.raises(PeerDisconnected):
        peer.receive(IS_POWERED)
    assert len(done) == 1


def test_port_that_disappears_later_first_sends_the_due_bytes() -> None:
    clock = SteppedClock()
    faults = (Truncated(after_bytes=3), Unplugged(seconds=0.5))
    peer = Scenario(name="test", faults=faults).wrap(SimulatedArm(TABLE), CODEC, clock=clock)
    assert peer.receive(IS_POWERED) == OFF[:3]
    assert peer.wait == 0.5
    clock.sleep(0.5)
    with pytest.raises(PeerDisconnected):
        peer.flush()


def test_faults_are_applied_in_their_order() -> None:
    leak, cut = ServoLeak(packets=("ping",)), Truncated(after_bytes=6)
    assert talk([leak, cut], [IS_POWERED]).data == PING
    assert talk([cut, leak], [IS_POWERED]).data == PING + OFF


@pytest.mark.parametrize(
    ("fault", "done_at"),
    [
        (Lost(), [0, 1, 2, 3, 4, 5]),
        (Lost(nth=(2, 5)), [1, 4]),
        (Lost(every=3), [2, 5]),
        (Lost(every=3, first=1), [0, 3]),
        (Lost(every=2, first=3), [2, 4]),
        (Lost(from_seconds=2, until_seconds=4), [2, 3]),
        (Lost(nth=(2,), from_seconds=2), []),
        (Lost(commands=("get_angles",)), []),
        (Lost(commands=("get_angles", 0x12), every=2), [1, 3, 5]),
        (Lost(only="acknowledgements"), []),
        (Lost(only="replies", nth=(1,)), [0]),
        (Lost(probability=0), []),
    ],
)
def test_fault_is_applied_to_these_requests(fault: Fault, done_at: list[int]) -> None:
    played = talk([fault], [IS_POWERED, 1.0] * 6)
    assert [done.at for done in played.applied] == done_at
    assert len(played.received) == 6 - len(done_at)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Late(seconds=-1), "late.seconds is -1; allowed: a number from 0 to 86400"),
        (lambda: Late(seconds=True), "late.seconds is True; allowed: a number"),
        (lambda: Lost(only="reply"), "did you mean replies?"),  # type: ignore[arg-type]
        (lambda: Lost(nth=(0,)), "lost.nth is (0,); allowed: a whole number from 1 to 1000000"),
        (lambda: Lost(from_seconds=2, until_seconds=1), "more than from_seconds, 2, up to 86400"),
        (lambda: Scenario(name="still", speed=0), "scenario.speed is 0; allowed: a number above 0"),
        (lambda: Inserted(data=b""), "1 to 4096 bytes as pairs of hex digits"),
    ],
)
def test_fault_with_an_illegal_value_is_rejected(make: object, words: str) -> None:
    assert callable(make)
    with pytest.raises(UsageError) as caught:
        make()
    assert words in str(caught.value)


def test_wrap_rejects_a_command_that_the_edition_lacks() -> None:
    with pytest.raises(UsageError, match="did you mean get_angles"):
        talk([Lost(commands=("get_angels",))], [])
