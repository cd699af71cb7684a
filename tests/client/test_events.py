"""Messages that a device sends without a request, and motions that end with one."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Iterator
from typing import Any

import pytest

from cobotwire import MotionTimeout, ReplyTimeout, RequestRefused, UsageError
from cobotwire import codec as codecs
from cobotwire.inspect.doctor import harmless_queries
from cobotwire.inspect.evidence import bare_queries
from cobotwire.protocol.messages import Event
from cobotwire.session import EventReceived, Traffic
from cobotwire.simulator import MemoryTransport, PtyServer, SimulatedArm, SteppedClock
from cobotwire_codegen.errors import SpecError
from conformance.device.testing import Altered, permissions, prepared
from memory_peer import MemoryPeer
from trial_specs import HEAD, edition_of, package_of

STAGED = f"""
{HEAD}
joints: 3
frame:
  frame:
    header: FE FE
    check: crc16-modbus
    length_counts: [command, data, check]
    maximum_data: 24
    doc: FE FE LEN CMD DATA and a CRC.
  transport: {{baudrate: 115200, deadline_ms: 200}}
acks:
  fields: [{{name: mark, type: mark, const: 255}}, {{name: status, type: status}}]
  accepted: [ACCEPTED]
  why: Each setter is accepted or refused.
types:
  wire:
    byte: {{bytes: 1, doc: A byte.}}
    word: {{bytes: 2, signed_at: 32767, doc: A signed word.}}
  quantities:
    mark: {{wire: byte, doc: A mark.}}
    angle: {{wire: word, scale: 1/100, unit: degree, doc: An angle.}}
    percent: {{wire: byte, range: [1, 100], unit: percent, doc: A speed.}}
    number: {{wire: byte, doc: A number.}}
  flags:
    flag: {{wire: byte, doc: Yes or no.}}
  enums:
    status:
      class: Status
      wire: byte
      doc: How it went.
      members:
        REFUSED: {{value: 0, doc: It is not carried out.}}
        ACCEPTED: {{value: 1, doc: It is carried out.}}
        NO_POWER: {{value: 3, doc: The arm has no power.}}
  values:
    angles: {{class: Angles, doc: The angles., items: {{j1: angle, j2: angle, j3: angle}}}}
commands:
  power_on:
    {{id: 0x10, title: Power on, doc: Powers the arm., safety: power,
     effect: {{sets: {{powered: true, held: true, free: false, connected: true}}}}}}
  get_angles:
    {{id: 0x20, title: Angles, doc: Angles., safety: query, role: joints,
     reply: [{{name: angles, type: angles}}]}}
  send_angles:
    {{id: 0x22, title: Send, doc: Sends., safety: motion, role: joint targets,
     request: [{{name: angles, type: angles}}, {{name: speed, type: percent}}]}}
  stop: {{id: 0x29, title: Stop, doc: Stops., safety: motion, role: stop}}
  motion_ended:
    {{id: 0x5B, title: Motion ended, doc: A motion has ended., safety: query, event: true,
     role: motion ended, accepted: [ACCEPTED], reply: [{{name: status, type: status}}]}}
  button_pressed:
    {{id: 0x5C, title: Button, doc: A button was pressed., safety: query, event: true,
     reply: [{{name: button, type: number}}, {{name: mark, type: mark, const: 7}}]}}
"""


@pytest.fixture(scope="module")
def staged(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """Yield the package of a robot with events."""
    with package_of(STAGED, tmp_path_factory.mktemp("staged")) as package:
        yield package


def frame(package: Any, name: str, *values: Any) -> bytes:
    """Return the bytes of a reply or event."""
    return codecs.load(package.TABLE).encode(name, "reply", values)


@pytest.mark.parametrize("codec", ["reference", "native"])
def test_event_is_a_typed_message_without_a_request(staged: Any, codec: codecs.CodecName) -> None:
    used = codecs.load(staged.TABLE, codec)
    message = used.decode("reply", frame(staged, "button_pressed", 3, 7))
    assert message.typed == staged.ButtonPressed(button=3)
    assert isinstance(message.typed, Event)
    assert message.typed.values == (3, 7)
    with pytest.raises(UsageError):
        used.encode("button_pressed", "request", ())
    assert not hasattr(staged.Trial, "button_pressed")


def test_event_between_request_and_reply_is_queued(staged: Any) -> None:
    both = frame(staged, "button_pressed", 1, 7) + frame(staged, "get_angles", (1.0, 2.0, 3.0))
    traffic: list[Traffic] = []
    arm = staged.Trial(MemoryTransport(MemoryPeer(both)), trace=traffic.append)
    with arm.events(staged.ButtonPressed, timeout=0.05) as events:
        assert arm.get_angles() == (1.0, 2.0, 3.0)
        assert list(events) == [staged.ButtonPressed(1)]
    assert [type(one.event) for one in traffic[1:2]] == [EventReceived]


def test_stream_yields_only_the_events_of_its_types(staged: Any) -> None:
    sent = [frame(staged, "button_pressed", n, 7) for n in range(3)]
    arm = staged.Trial(MemoryTransport(MemoryPeer(frame(staged, "motion_ended", 1).join(sent))))
    some = arm.events(staged.ButtonPressed, timeout=0.05)
    every = arm.events(timeout=0.05)
    arm.stop()
    assert [event.button for event in some] == [0, 1, 2]
    assert [type(event).__name__ for event in every][1] == "MotionEnded"


def test_full_queue_drops_the_oldest_and_counts_it(staged: Any) -> None:
    sent = b"".join(frame(staged, "button_pressed", n, 7) for n in range(5))
    arm = staged.Trial(MemoryTransport(MemoryPeer(sent)))
    events = arm.events(capacity=2, timeout=0.05)
    arm.stop()
    arm.listen(0.01)
    assert [event.button for event in events] == [3, 4]
    assert events.lost == 3


def test_handler_is_called_and_its_errors_are_reported(
    staged: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen, errors = [], []
    monkeypatch.setattr("sys.excepthook", lambda kind, error, traceback: errors.append(error))

    def handle(event: Any) -> None:
        seen.append((event.button, threading.get_ident()))
        if event.button == 1:
            raise ValueError("a mistake")

    both = b"".join(frame(staged, "button_pressed", n, 7) for n in (1, 2))
    reply = frame(staged, "get_angles", (0, 0, 0))
    arm = staged.Trial(MemoryTransport(MemoryPeer(both + reply, both + reply)))
    handler = arm.on(staged.ButtonPressed, handle)
    arm.get_angles()
    assert seen == [(1, threading.get_ident()), (2, threading.get_ident())]
    assert [str(error) for error in errors] == ["a mistake"]
    assert (handler.failures, handler.error) == (1, errors[0])
    handler.remove()
    handler.remove()
    arm.get_angles()
    assert len(seen) == 2, "a removed handler is not called"


def test_wrong_event_or_handler_is_an_error(staged: Any) -> None:
    async def coroutine(event: Any) -> None:
        pass

    arm = staged.Trial(MemoryTransport(MemoryPeer()))
    with pytest.raises(UsageError, match="motion_ended, button_pressed"):
        arm.events(staged.GetAngles)
    with pytest.raises(UsageError, match="a function"):
        arm.on(staged.ButtonPressed, coroutine)
    with pytest.raises(UsageError, match="capacity"):
        arm.events(capacity=0)
    from cobotwire import MyCobot280

    with pytest.raises(UsageError, match="has no events"):
        MyCobot280(MemoryTransport(MemoryPeer())).events()


def test_asyncio_client_iterates_events(staged: Any) -> None:
    async def collect(url: str) -> list[Any]:
        async with staged.AsyncTrial(url) as arm:
            await arm.power_on(ack_within=2)
            seen: list[Any] = []
            arm.on(staged.MotionEnded, seen.append)
            async with arm.events(staged.MotionEnded, timeout=5) as events:
                await arm.send_angles((3.0, 0.0, 0.0), 100, ack_within=2)
                async for event in events:
                    some = [
                        button async for button in arm.events(staged.ButtonPressed, timeout=0.1)
                    ]
                    return [event, *seen, *some]
            return []

    with PtyServer(SimulatedArm(staged.TABLE)) as server:
        ended = staged.MotionEnded(staged.Status.ACCEPTED)
        assert asyncio.run(collect(server.url)) == [ended, ended]


def test_refused_status_is_an_error_with_its_name(staged: Any) -> None:
    arm = staged.Trial(MemoryTransport(MemoryPeer(frame(staged, "power_on", 255, 3))))
    with pytest.raises(RequestRefused, match=r"power_on\(\): status is NO_POWER \(3\)") as caught:
        arm.power_on(ack_within=0.5)
    assert (caught.value.field, caught.value.status) == ("status", "NO_POWER (3)")
    accepted = staged.Trial(MemoryTransport(MemoryPeer(frame(staged, "power_on", 255, 1))))
    accepted.power_on(ack_within=0.5)
    with pytest.raises(ReplyTimeout):
        accepted.power_on(ack_within=0.05)


def test_refused_motion_is_not_waited_for(staged: Any) -> None:
    peer = MemoryPeer(frame(staged, "send_angles", 255, 3))
    arm = staged.Trial(MemoryTransport(peer))
    with pytest.raises(RequestRefused, match="NO_POWER"):
        arm.move_angles((60.0, 0.0, 0.0), 50)


def test_motion_that_ends_with_a_bad_status_is_stopped(staged: Any) -> None:
    here = frame(staged, "get_angles", (0.0, 0.0, 0.0))
    peer = MemoryPeer(frame(staged, "send_angles", 255, 1), here + frame(staged, "motion_ended", 0))
    arm = staged.Trial(MemoryTransport(peer))
    with pytest.raises(RequestRefused, match=r"REFUSED \(0\)"):
        arm.move_angles((60.0, 0.0, 0.0), 50)
    assert peer.received.endswith(codecs.load(staged.TABLE).encode("stop", "request", ()))


def test_arm_without_power_reports_no_end(staged: Any) -> None:
    clock = SteppedClock()
    transport = MemoryTransport(SimulatedArm(staged.TABLE, clock=clock), clock)
    with pytest.raises(MotionTimeout):
        staged.Trial(transport).move_angles((60.0, 0.0, 0.0), 50, timeout=2)


def test_tools_send_nothing_for_an_event(staged: Any) -> None:
    assert [query.name for query in bare_queries(staged.TABLE)] == ["get_angles"]
    assert [query.name for query in harmless_queries(staged.TABLE)] == ["get_angles"]


@pytest.mark.parametrize("mark", [7, 8])
def test_device_may_send_events_at_any_time(staged: Any, mark: int) -> None:
    legal = frame(staged, "button_pressed", 3, 7)
    data = bytes.fromhex("FE FE 05 5C 03") + bytes([mark])
    sent = legal if mark == 7 else data + staged.TABLE.frame.end(data)

    def before_each_reply(arm: SimulatedArm) -> Altered:
        return Altered(arm, lambda request, reply, number: sent + reply)

    report = prepared(staged.TABLE, before_each_reply, permissions=permissions()).run()
    assert report.conforms == (mark == 7)


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("accepted: [ACCEPTED]\n  why", "accepted: [DONE]\n  why", "wrong-kind"),
        ("event: true,\n     reply", "event: true,\n     ack: true, reply", "bad-event"),
    ],
)
def test_spec_with_a_wrong_event_is_reported(tmp_path: Any, old: str, new: str, code: str) -> None:
    assert old in STAGED
    try:
        _, problems = edition_of(STAGED.replace(old, new), tmp_path)
    except SpecError as error:
        problems = list(error.problems)
    assert code in [problem.code for problem in problems]
