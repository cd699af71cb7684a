"""Clients of a robot with addresses: each request, and each reply, belongs to one device."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from both_ways import InLoop
from cobotwire import DeadMan, MyBuddy, ReplyTimeout, UsageError
from cobotwire import codec as codecs
from cobotwire.client.aio_dead_man import AsyncDeadMan
from cobotwire.diagnose.explain import format_message, frame_parts
from cobotwire.editions import mybuddy
from cobotwire.protocol.addresses import find_address
from cobotwire.session import AckReceived, Exchange, LateReply, ReplyMatched, RetryPolicy
from cobotwire.session.request import RequestEncoder
from cobotwire.simulator import MemoryTransport, PtyServer, SimulatedArm, SteppedClock
from conformance.device.testing import Altered, permissions, prepared
from memory_peer import MemoryPeer
from session.one_caller import submit
from transport.ends import PtyEnd
from trial_specs import HEAD, edition_of, package_of

DUO = f"""
{HEAD}
joints: 2
state:
  red: {{type: colour}}
  green: {{type: colour}}
  blue: {{type: colour}}
frame:
  frame:
    header: FE FE
    check: sum
    length_counts: [command, data, check]
    addresses:
      ALL: {{value: 0, doc: Both arms., replies: any}}
      LEFT: {{value: 1, doc: The left arm.}}
      RIGHT: {{value: 2, doc: The right arm.}}
      QUIET: {{value: 9, doc: Both arms without a reply., replies: none}}
    maximum_data: 16
    doc: FE FE ID LEN CMD DATA and a sum.
  transport: {{baudrate: 115200, deadline_ms: 200}}
types:
  wire:
    byte: {{bytes: 1, doc: A byte.}}
    word: {{bytes: 2, signed_at: 32767, doc: A signed word.}}
  quantities:
    angle: {{wire: word, scale: 1/100, unit: degree, doc: An angle.}}
    percent: {{wire: byte, range: [1, 100], unit: percent, doc: A speed.}}
    colour: {{wire: byte, doc: A part of a colour.}}
  flags:
    flag: {{wire: byte, doc: Yes or no.}}
  values:
    angles: {{class: Angles, doc: The angles., items: {{j1: angle, j2: angle}}}}
commands:
  power_on:
    {{id: 0x10, title: Power on, doc: Powers the arm., safety: power,
     effect: {{sets: {{powered: true, held: true, free: false, connected: true}}}}}}
  set_color:
    id: 0x6A
    title: Set the colour
    doc: Sets the colour.
    safety: setting
    effect: {{stores: {{red: red, green: green, blue: blue}}}}
    ack: true
    request:
      - {{name: red, type: colour}}
      - {{name: green, type: colour}}
      - {{name: blue, type: colour}}
    reply: [{{name: done, type: flag}}]
  get_angles:
    id: 0x20
    title: Read the angles
    doc: Reads the angles.
    safety: query
    role: joints
    reply: [{{name: angles, type: angles}}]
  send_angles:
    id: 0x22
    title: Send the angles
    doc: Sends the angles.
    safety: motion
    role: joint targets
    request: [{{name: angles, type: angles}}, {{name: speed, type: percent}}]
  stop: {{id: 0x29, title: Stop, doc: Stops the arm., safety: motion, role: stop}}
"""
LEFT, RIGHT, ALL = 1, 2, 0


@pytest.fixture(scope="module")
def duo(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """Yield the package of a robot with two arms."""
    with package_of(DUO, tmp_path_factory.mktemp("duo")) as package:
        yield package


def angles_from(duo: Any, address: int, first: float) -> bytes:
    """Return the reply of the device that has an address."""
    codec = codecs.load(duo.TABLE)
    return codec.encode("get_angles", "reply", [(first, 0.0)], address=address)


@pytest.mark.parametrize("asynchronous", [False, True])
def test_each_address_is_an_arm_with_a_state_of_its_own(duo: Any, asynchronous: bool) -> None:
    robot = SimulatedArm(duo.TABLE, powered=True)
    with PtyServer(robot) as server:
        opened = (
            InLoop(duo.AsyncTrial, server.url, address=duo.Trial.LEFT)
            if asynchronous
            else duo.Trial(server.url, address=duo.Trial.LEFT)
        )
        with opened as arm:
            robot.state_at(LEFT).angles.place((10.0, 0.0), robot.clock())
            robot.state_at("right").angles.place((0.0, 20.0), robot.clock())
            assert arm.get_angles() == (10.0, 0.0)
            assert arm.right.get_angles() == arm.at("RIGHT").get_angles() == (0.0, 20.0)
            assert arm.at(LEFT).get_angles() == (10.0, 0.0)
            arm.left.set_color(1, 2, 3, ack_within=2)
            arm.right.set_color(4, 5, 6, ack_within=2)
    assert [robot.state_at(each).light for each in (LEFT, RIGHT)] == [(1, 2, 3), (4, 5, 6)]


def test_broadcast_takes_the_reply_of_any_address(duo: Any) -> None:
    arm = duo.Trial(MemoryTransport(MemoryPeer(angles_from(duo, RIGHT, 5.0))))
    assert arm.get_angles() == (5.0, 0.0)


def test_broadcast_reaches_every_device(duo: Any) -> None:
    robot = SimulatedArm(duo.TABLE)
    with duo.Trial(MemoryTransport(robot)) as arm:
        arm.set_color(7, 8, 9)
        arm.quiet.power_on()
        with pytest.raises(UsageError, match="nobody replies to the address QUIET"):
            arm.quiet.get_angles()
        with pytest.raises(UsageError, match="cannot be waited for"):
            arm.quiet.set_color(1, 1, 1, ack_within=1)
    states = [robot.state_at(each) for each in (LEFT, RIGHT)]
    assert [(state.light, state.powered) for state in states] == [((7, 8, 9), True)] * 2


def test_acknowledgement_of_another_address_is_not_counted(duo: Any) -> None:
    codec = codecs.load(duo.TABLE)
    peer = MemoryPeer(codec.encode("set_color", "reply", [True], address=RIGHT))
    arm = duo.Trial(MemoryTransport(peer), address=LEFT)
    with pytest.raises(ReplyTimeout):
        arm.set_color(1, 2, 3, ack_within=0.05)


def test_failure_in_the_block_stops_every_address_that_was_used(duo: Any) -> None:
    peer = MemoryPeer()
    with suppress(ZeroDivisionError), duo.Trial(MemoryTransport(peer), address=LEFT) as arm:
        arm.right.send_angles((1, 2), 50)
        raise ZeroDivisionError
    assert peer.received.endswith(bytes.fromhex("FE FE 01 02 29 29 FE FE 02 02 29 29"))


@pytest.mark.parametrize("asynchronous", [False, True])
@pytest.mark.parametrize("by", ["block", "dead man"])
def test_stop_through_a_view_reaches_the_device_of_the_first_client(
    duo: Any, asynchronous: bool, by: str
) -> None:
    pty = PtyEnd()
    if asynchronous:
        asyncio.run(_stop_in_loop(duo.AsyncTrial(pty.url, address=LEFT), by))
    else:
        first = duo.Trial(pty.url, address=LEFT)
        with suppress(ZeroDivisionError), first.right.left.right as view:
            assert view.left is first
            if by == "block":
                raise ZeroDivisionError
            with DeadMan(view, 0.01):
                time.sleep(0.1)
    assert pty.drain() == bytes.fromhex("FE FE 01 02 29 29 FE FE 02 02 29 29")
    pty.unplug()


async def _stop_in_loop(first: Any, by: str) -> None:
    with suppress(ZeroDivisionError):
        async with first.right as view:
            if by == "block":
                raise ZeroDivisionError
            async with AsyncDeadMan(view, 0.01):
                await asyncio.sleep(0.1)


@pytest.mark.parametrize("given", [7, "top", True])
def test_unknown_address_is_an_error_that_lists_the_known_ones(duo: Any, given: Any) -> None:
    with pytest.raises(UsageError, match=r"ALL \(0\), LEFT \(1\), RIGHT \(2\), QUIET \(9\)"):
        duo.Trial(MemoryTransport(MemoryPeer()), address=given)


def test_edition_without_addresses_takes_none() -> None:
    from cobotwire import MyCobot280

    with pytest.raises(UsageError, match="edition mycobot280 has no addresses") as caught:
        MyCobot280(MemoryTransport(MemoryPeer()), address=1)
    assert (caught.value.argument, caught.value.value) == ("address", 1)


def test_stream_samples_the_address_of_its_client(duo: Any) -> None:
    arm = duo.Trial(MemoryTransport(MemoryPeer(angles_from(duo, RIGHT, 3))), address=LEFT)
    query = duo.GetAngles()
    assert next(iter(arm.right.stream(query, rate=50)))[query] == (3.0, 0.0)


def test_address_that_would_hide_a_command_is_reported(tmp_path: Any) -> None:
    for name in ("GET_ANGLES", "STREAM", "left"):
        _, problems = edition_of(DUO.replace("QUIET", name), tmp_path)
        assert [problem.code for problem in problems] == ["reserved-name"], name


TARGETS = st.sampled_from([ALL, LEFT, RIGHT])


@pytest.mark.usefixtures("repeated_in_rust")
@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(TARGETS, st.lists(st.sampled_from([LEFT, RIGHT]), max_size=3)), max_size=5)
)
def test_reply_belongs_to_a_request_only_if_its_address_does(duo: Any, talk: Any) -> None:
    codec = codecs.load(duo.TABLE, "reference")
    exchange, policy, now = Exchange(codec), RetryPolicy(attempts=1), 0.0
    for target, repliers in talk:
        request = RequestEncoder(codec, find_address(duo.TABLE, target)).encode("get_angles", [])
        pending = submit(exchange, request, now, policy)
        # After this time no late reply can arrive.
        now += 5.0
        assert exchange.outgoing(now, drained=True) == request.frame
        right = [target in (ALL, replier) for replier in repliers]
        for index, replier in enumerate(repliers):
            [event] = exchange.receive(angles_from(duo, replier, float(index)), now)
            assert isinstance(event, ReplyMatched) == (right[index] and not any(right[:index]))
            assert not isinstance(event, AckReceived)
            if right[index] and any(right[:index]) and target == ALL:
                assert isinstance(event, LateReply)
        assert pending.done == any(right)
        if pending.done:
            assert pending.result()["angles"] == (float(right.index(True)), 0.0)
        exchange.give_up(pending)


def test_device_under_test_has_an_address(duo: Any) -> None:
    report = prepared(duo.TABLE, address="RIGHT", permissions=permissions()).run()
    assert report.conforms
    assert report.subject.endswith("at address RIGHT")


def test_reply_with_another_address_fails_a_device(duo: Any) -> None:
    def misaddressed(request: bytes, reply: bytes, number: int) -> bytes:
        return reply.replace(b"\xfe\xfe\x02", b"\xfe\xfe\x01")

    report = prepared(
        duo.TABLE,
        lambda arm: Altered(arm, misaddressed),
        address="RIGHT",
        permissions=permissions(),
    ).run()
    assert not report.conforms


def test_explanations_name_the_address(duo: Any) -> None:
    codec = codecs.load(duo.TABLE)
    frame = angles_from(duo, RIGHT, 5.0)
    message = codec.decode("reply", frame)
    assert format_message(message).endswith("from address 2")
    assert ("address", "RIGHT") in [
        (part.name, part.meaning) for part in frame_parts(duo.TABLE, frame, message)
    ]


def test_waist_has_one_joint() -> None:
    clock = SteppedClock()
    robot = SimulatedArm(mybuddy.TABLE, clock=clock, powered=True)
    with MyBuddy(MemoryTransport(robot, clock)) as arm:
        assert robot.state_at("waist").joints == 1
        with pytest.raises(UsageError, match="a value for each of 6 joints, and WAIST has 1 joint"):
            arm.waist.get_angles()
        arm.waist.send_angle(2, 30, 50)
        with pytest.raises(ReplyTimeout):
            arm.waist.get_angle(2)
    assert "WAIST has no joint 2" in robot.notes[-1].text
