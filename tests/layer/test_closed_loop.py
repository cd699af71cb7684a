"""The classes of the Mercury and the Pro robots: the arm reports the end of each motion."""

from __future__ import annotations

import signal
from functools import partial
from typing import Any

import pytest

import cobotwire.pymycobot as layer
from cobotwire.editions import mercury_a1, mercury_b1
from cobotwire.protocol.errors import (
    ArmNotReady,
    ReplyTimeout,
    RequestRefused,
    UsageError,
)
from cobotwire.session import RequestReceived
from cobotwire.simulator import PtyServer, SimulatedArm
from layer.arms import made
from memory_peer import MemoryPeer
from strategies import codec_of

HOME = [0, 0, 0, 0, 0, 90, 0]
# The id of a request; the first bytes and the size of the frame that reports the end of a motion.
SEND_ANGLES, END, END_SIZE = 0x22, bytes([0xFE, 0xFE, 4, 0x5B]), 7


class NeverReports:
    """A robot that never reports the end of a motion."""

    def __init__(self, arm: SimulatedArm) -> None:
        self._arm = arm.connect()

    @property
    def wait(self) -> float | None:
        return self._arm.wait

    def receive(self, data: bytes) -> bytes:
        return self._without_ends(self._arm.receive(data))

    def flush(self) -> bytes:
        return self._without_ends(self._arm.flush())

    def _without_ends(self, data: bytes) -> bytes:
        before, found, after = data.partition(END)
        return before + after[END_SIZE - len(END) :] if found else data


class Early(NeverReports):
    """A robot that reports the end of an earlier motion after it has accepted the next one."""

    def receive(self, data: bytes) -> bytes:
        reply = super().receive(data)
        early = codec_of("mercury_a1", "native").encode("motion_ended", "reply", (0,))
        return reply + early if data[3] == SEND_ANGLES else reply

    def _without_ends(self, data: bytes) -> bytes:
        return data


@pytest.mark.parametrize(
    ("name", "edition", "target"),
    [
        ("Mercury", "mercury_a1", HOME),
        ("MercurySocket", "", HOME),
        ("Pro400", "", [10] * 6),
        ("Pro630Client", "", [10] * 6),
        ("Pro450Client", "", [10] * 6),
    ],
)
def test_motion_returns_when_the_arm_arrives(name: str, edition: str, target: list[float]) -> None:
    arm, _ = made(name, edition)
    before = arm.clock()
    assert arm.send_angles(target, 20) in (0, 1)
    assert arm.get_angles() == pytest.approx(target, abs=0.1)
    assert arm.clock() - before > 0.1
    before = arm.clock()
    assert arm.send_angles([0] * len(target), 20, _async=True) == 1
    assert arm.clock() - before < 0.1


def test_motion_after_an_asynchronous_one_waits_for_its_own_end() -> None:
    arm, _ = made("Mercury", "mercury_a1", peer=Early)
    arm.send_angle(1, 10, 50, _async=True)
    assert arm.send_angles([40, 0, 0, 0, 0, 0, 0], 5) == 0
    assert arm.get_angle(1) == pytest.approx(40, abs=0.1)


def test_failed_motion_raises_or_returns_its_status() -> None:
    arm, _ = made("Mercury", "mercury_a1", powered=False)
    with pytest.raises(RequestRefused, match=r"send_angles\(\): status is "):
        arm.send_angles(HOME, 50)
    arm, _ = made("Mercury", "mercury_a1", errors="return", powered=False)
    assert arm.send_angles(HOME, 50) > 1


def test_lost_end_of_a_motion_raises_reply_timeout() -> None:
    arm, _ = made("Mercury", "mercury_a1", peer=NeverReports)
    with pytest.raises(ReplyTimeout, match=r"send_angles\(\) at the end of its motion"):
        arm.send_angles(HOME, 50)
    arm, _ = made("Mercury", "mercury_a1", errors="return", peer=NeverReports)
    assert arm.send_angles(HOME, 50) == -1
    assert arm.get_angles() == pytest.approx(HOME, abs=0.1)


@pytest.mark.parametrize("method", ["send_angles", "sync_send_angles"])
def test_ctrl_c_that_a_program_handles_stops_the_motion(method: str) -> None:
    received: list[Any] = []

    def note(event: Any, _: bytes) -> None:
        if isinstance(event, RequestReceived):
            received.append(event.message.command.name)

    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    try:
        with PtyServer(SimulatedArm(mercury_a1.TABLE, powered=True, on_event=note)) as server:
            arm = layer.Mercury(server.url)
            signal.setitimer(signal.ITIMER_REAL, 0.3)
            with pytest.raises(KeyboardInterrupt):
                getattr(arm, method)(HOME, 1)
            arm.arm.listen(0.2)  # the arm takes some time to stop
            assert arm.is_moving() == 0
            assert (received.count("send_angles"), received.count("stop")) == (1, 1)
            arm.close()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


class Silent(NeverReports):
    """A robot that never reports the end of a motion, and does not reply to ``is_moving``."""

    def receive(self, data: bytes) -> bytes:
        reply = super().receive(data)
        return b"" if data[3] == mercury_a1.TABLE.in_role("moving").id else reply


def test_arm_that_may_move_after_an_error_is_stopped_and_a_wrong_argument_sends_nothing() -> None:
    received: list[Any] = []
    arm, _ = made(
        "Mercury",
        "mercury_a1",
        peer=Silent,
        on_event=lambda event, _: received.append(event.message.command.name),
    )
    with pytest.raises(UsageError):
        arm.send_angles(HOME, 101)
    assert "stop" not in received
    with pytest.raises(ReplyTimeout):
        arm.send_angles(HOME, 1)
    assert received.count("stop") == 1


def test_motions_do_not_wait_if_their_ends_are_not_reported() -> None:
    arm, _ = made("Mercury", "mercury_a1")
    assert arm.set_limit_switch(2, 0) == 1
    before = arm.clock()
    assert arm.send_angles(HOME, 5) == 1
    assert arm.clock() - before < 0.1
    arm.open()
    assert arm.send_angles(HOME, 5) == 1


def test_simulated_arm_reports_ends_only_while_the_reports_are_on() -> None:
    arm, _ = made("Mercury", "mercury_a1")
    assert arm.get_limit_switch() == [1, 1]
    arm.set_limit_switch(2, 0)
    with arm.arm.events(mercury_a1.MotionEnded, timeout=5) as ends:
        arm.send_angles(HOME, 50)
        assert list(ends) == []
        arm.set_limit_switch(2, 1)
        arm.send_angle(1, 10, 50, _async=True)
        assert next(ends).status == 0


@pytest.mark.parametrize(
    ("method", "arguments", "why"),
    [
        ("set_limit_switch", (2, 1), "the arm has no power; call power_on()"),
        ("drag_teach_execute", (), "no points are recorded"),
    ],
)
def test_command_that_cannot_work_says_why(
    method: str, arguments: tuple[Any, ...], why: str
) -> None:
    arm, _ = made("Mercury", "mercury_a1", powered=False)
    with pytest.raises(ArmNotReady) as raised:
        getattr(arm, method)(*arguments)
    assert why in str(raised.value)
    arm, _ = made("Mercury", "mercury_a1", errors="return", powered=False)
    assert getattr(arm, method)(*arguments) == -1


def test_arm_that_is_silent_can_be_opened() -> None:
    arm, _ = made("Mercury", "mercury_a1", errors="return", peer=lambda _: MemoryPeer())
    assert arm.get_angles() == -1


def test_name_of_the_port_says_which_robot_it_is() -> None:
    with PtyServer(SimulatedArm(mercury_b1.TABLE)) as server:

        class OnBody(layer.Mercury):
            PORTS = (server.url, "/dev/right_arm")

        arm = OnBody(server.url)
        assert isinstance(arm.arm, mercury_b1.MercuryB1)
        assert arm.get_servo_cw(11) == 0
        arm.close()
    with PtyServer(SimulatedArm(mercury_a1.TABLE)) as server:
        alone = layer.Mercury(server.url)
        assert isinstance(alone.arm, mercury_a1.MercuryA1)
        for call in (alone.get_base_coords, partial(alone.is_in_position, [0] * 6, 2)):
            with pytest.raises(
                UsageError,
                match="needs an arm that is mounted on a body: its port is /dev/left_arm",
            ):
                call()
        alone.close()
