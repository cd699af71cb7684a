"""Run ``cobotwire ros2`` with a participant that takes its types and bytes from rosbags."""

from __future__ import annotations

import asyncio
import math
import signal
import time
from collections.abc import Callable, Coroutine, Sequence
from contextlib import suppress
from functools import wraps
from itertools import count
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import Limits, MyCobot280, UsageError
from cobotwire.capture.export import ros_messages as ros
from cobotwire.editions.mycobot280 import TABLE, AsyncMyCobot280
from cobotwire.simulator import MemoryTransport, PtyServer, SimulatedArm
from command_line import started
from in_process import cobotwire

pytest.importorskip("cyclonedds", reason="cyclonedds has no wheel for this Python or machine")

from cyclonedds.core import DDSException
from cyclonedds.domain import Domain

from adapters.ros_participant import (
    LOCALHOST,
    SECONDS,
    STORE,
    Participant,
    received,
    sample,
    struct,
)
from cobotwire.adapters.ros2 import dds
from cobotwire.adapters.ros2.bridge import Bridge, numbers_of
from cobotwire.adapters.ros2.motion import waypoints_of

ANGLES = [10.0, -20.0, 30.0, -40.0, 50.0, -60.0]
NAMES = ["j1", "j2", "j3", "j4", "j5", "j6"]
STOP = bytes.fromhex("FE FE 02 29 FA")
# DDS keeps the configuration of a domain while a participant lives: each test has its own domain.
DOMAINS = count(100)


def moves(frame: bytes) -> bool:
    """Return whether a frame is send_angles."""
    return frame[3] == 0x22


def in_loop(test: Callable[..., Coroutine[Any, Any, None]]) -> Callable[..., None]:
    """Run a test in an event loop."""
    return wraps(test)(lambda **arguments: asyncio.run(test(**arguments)))


class Published:
    """A simulated arm that is published while the block runs, and a participant."""

    def __init__(self, silence: float | None = None, limits: Limits | None = None) -> None:
        self.ahead = 0.0
        self.robot = SimulatedArm(TABLE, clock=lambda: time.monotonic() + self.ahead, powered=True)
        with MyCobot280(MemoryTransport(self.robot.connect())) as arm:
            arm.send_angles(ANGLES, 100)
        self.ahead = 10.0
        self.sent: list[bytes] = []
        self.arm = AsyncMyCobot280(MemoryTransport(self.robot), limits=limits, trace=self._note)
        self._silence = silence

    def _note(self, traffic: Any) -> None:
        if traffic.direction == "sent":
            self.sent.append(traffic.data)

    async def __aenter__(self) -> Published:
        domain = next(DOMAINS)
        await self.arm.open()
        self._bridge = Bridge(
            self.arm, dds.Participant(domain, dds.network(None, {})), "memory", 50, self._silence
        )
        self.other = Participant(domain)
        self._reports = self.other.reader("rt/diagnostics", ros.DIAGNOSTICS)
        self.running = asyncio.create_task(self._bridge.run())
        return self

    async def __aexit__(self, *error: object) -> None:
        self.running.cancel()
        await asyncio.wait([self.running])
        await self.arm.close()

    async def report(self, part: str, text: str = "") -> Any:
        """Return the next status of a part with a message that contains ``text``."""

        def found(message: Any) -> Any:
            named = (each for each in message.status if each.name == f"cobotwire: {part}")
            return next((each for each in named if text in each.message), None)

        return await received(self._reports, found)


def trajectory(*points: tuple[Sequence[float], float], names: Sequence[str] = NAMES) -> Any:
    """Return a JointTrajectory with positions in degrees and times in seconds."""
    types = STORE.types
    stamp = types["builtin_interfaces/msg/Time"](0, 0)
    made = []
    for degrees, seconds in points:
        nanosec = round(seconds % 1 * 10**9)
        moment = types["builtin_interfaces/msg/Duration"](math.floor(seconds), nanosec)
        none, radians = np.array([]), np.radians(degrees)
        point = types["trajectory_msgs/msg/JointTrajectoryPoint"]
        made.append(point(radians, none, none, none, moment))
    message = types[ros.JOINT_TRAJECTORY](types["std_msgs/msg/Header"](stamp, ""), [*names], made)
    data = bytes(STORE.serialize_cdr(message, ros.JOINT_TRAJECTORY))
    return sample(ros.JOINT_TRAJECTORY, data.replace(b"@@", b"\xff\xfe"))


@in_loop
async def test_joints_and_end_are_published_in_radians_and_metres() -> None:
    async with Published() as here:
        states = here.other.reader("rt/joint_states", "sensor_msgs/msg/JointState")
        state = await received(states)
        assert state.name == NAMES
        assert np.degrees(state.position) == pytest.approx(ANGLES, abs=0.1)
        assert abs(state.header.stamp.sec - time.time()) < 2
        transforms = here.other.reader("rt/tf", "tf2_msgs/msg/TFMessage", 100)
        (moved,) = (await received(transforms)).transforms
        assert (moved.header.frame_id, moved.child_frame_id) == ("base", "end")
        to = moved.transform.translation
        coords = await here.arm.get_coords()
        assert [to.x * 1000, to.y * 1000, to.z * 1000] == pytest.approx(coords[:3])


@in_loop
async def test_diagnostics_report_the_state_of_transport_and_arm() -> None:
    async with Published() as here:
        line, arm = await here.report("line"), await here.report("arm")
        assert (line.level, line.message) == (0, "replies come in time")
        assert (arm.level, arm.message) == (0, "obeys motions")
        temperatures = " ".join(map(str, await here.arm.get_servo_temps()))
        values = {each.key: each.value for each in arm.values}
        assert temperatures in values.values()
        await here.arm.power_off()
        arm = await here.report("arm", "the arm has no power")
        assert arm.level == 2


@in_loop
async def test_arm_follows_a_trajectory_with_its_times_and_its_order_of_joints() -> None:
    async with Published(silence=5) as here:
        writer = here.other.writer("rt/joint_trajectory", ros.JOINT_TRAJECTORY)
        there = [angle + 10 for angle in ANGLES]
        points = [(ANGLES[::-1], 0.0), (there[::-1], 1.0)]
        writer.write(trajectory(*points, names=NAMES[::-1]))
        await here.report("motion", "follows 2 points")
        assert (await here.report("motion", "arrived")).level == 0
        assert await here.arm.get_angles() == pytest.approx(there, abs=1)
        assert STOP not in here.sent


@pytest.mark.parametrize(
    "how", ["an empty trajectory", "gone sender", "another, idle sender", "Ctrl-C"]
)
@in_loop
async def test_motion_under_way_is_stopped_once(how: str) -> None:
    async with Published(silence=0.05) as here:
        writer = here.other.writer("rt/joint_trajectory", ros.JOINT_TRAJECTORY)
        writer.write(trajectory(([angle + 60 for angle in ANGLES], 5.0)))
        async with asyncio.timeout(SECONDS):
            while not any(map(moves, here.sent)):
                await asyncio.sleep(0.01)
        if how == "Ctrl-C":
            here.running.cancel()
            await asyncio.wait([here.running])
        elif how.endswith("sender"):
            idle = how.startswith("another")
            other = here.other.writer("rt/joint_trajectory", ros.JOINT_TRAJECTORY) if idle else None
            del writer
            await here.report("motion", "stopped: its sender is gone")
            del other
        else:
            writer.write(trajectory())
            await here.report("motion", "stopped: a newer trajectory was received")
        stopped = here.sent.index(STOP)
        await asyncio.sleep(0.1)
        assert here.sent.count(STOP) == 1
        assert not [each for each in here.sent[stopped:] if moves(each)]


FAST = tuple(angle + 60 for angle in ANGLES)
REFUSED = {
    "joint_names is 'j1 j2 j3 j4 j5 j5'": trajectory((ANGLES, 1), names=[*NAMES[:5], "j5"]),
    "joint_names is 'j1'": trajectory((ANGLES[:1], 1), names=["j1"]),
    "path[1]: angles.j6 is nan": trajectory((ANGLES, 1), ([*ANGLES[:5], math.nan], 2)),
    "points[0].positions": trajectory((ANGLES[:5], 1)),
    "path[1].time is 1.0": trajectory((ANGLES, 1), (ANGLES, 1)),
    "path[0].time is -1.0": trajectory((ANGLES, -1)),
    "allowed: a number -168..168": trajectory((ANGLES, 1), ([170, 0, 0, 0, 0, 0], 9)),
    "times as long": trajectory((FAST, 0.1)),
    "points[1].time is 601.0": trajectory((ANGLES, 1), (ANGLES, 601)),
    "limits.workspace allows": trajectory(([10, 90, 0, 0, 0, 0], 9)),
    "is damaged": trajectory((ANGLES, 1), names=[*NAMES[:5], "@@"]),
}


@in_loop
async def test_trajectory_that_is_not_allowed_is_refused_whole_with_the_reason() -> None:
    box = Limits(workspace=[(-50, 400), (-250, 250), (0, 500)])
    async with Published(silence=5, limits=box) as here:
        writer = here.other.writer("rt/joint_trajectory", ros.JOINT_TRAJECTORY)
        for text, message in REFUSED.items():
            writer.write(message)
            refused = await here.report("motion", text)
            assert refused.level == 2
            assert refused.message.startswith("refused: ")
        # The arm received only queries, which carry no data.
        assert {each[2] for each in here.sent} == {2}


def test_definitions_are_those_of_rosbags() -> None:
    for kind in (ros.JOINT_STATE, ros.TF_MESSAGE, ros.DIAGNOSTICS, ros.JOINT_TRAJECTORY):
        ours = ros.schema_text(kind).split(f"{'=' * 80}\n")
        theirs = STORE.generate_msgdef(kind, ros_version=2)[0].split(f"{'=' * 80}\n")
        # Our definitions omit the constants.
        theirs = ["".join(n for n in part.splitlines(True) if "=" not in n) for part in theirs]
        assert sorted(ours) == sorted(theirs)


texts = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"))


@given(texts, st.lists(texts), st.lists(st.floats(allow_nan=False)), st.integers(0, 255))
def test_messages_are_encoded_as_by_cyclone_and_rosbags(
    text: str, names: list[str], values: list[float], level: int
) -> None:
    arrays = dict.fromkeys(("position", "velocity", "effort"), values)
    state = {"header": ros.header(1_700_000_000_123_456_789, text), "name": names, **arrays}
    status = {"level": level, "name": text, "message": text, "hardware_id": text}
    pairs = [{"key": name, "value": text} for name in names]
    report = {"header": state["header"], "status": [{**status, "values": pairs}] * len(values)}
    for kind, message in ((ros.JOINT_STATE, state), (ros.DIAGNOSTICS, report)):
        data = ros.serialised(kind, message)
        assert bytes(STORE.serialize_cdr(STORE.deserialize_cdr(data, kind), kind)) == data
        made = struct(kind).__idl__.deserialize(data)
        assert made.__idl__.serialize(made, use_version_2=False) == data


def test_any_bytes_are_a_message_or_damaged() -> None:
    domain = next(DOMAINS)
    here = dds.Participant(domain, dds.network(None, {}))
    reader = here.reader("any", ros.JOINT_TRAJECTORY)
    writer = Participant(domain).writer("rt/any", ros.JOINT_TRAJECTORY)
    right = trajectory((ANGLES, 1)).serialize()

    @given(st.binary(max_size=100), st.integers(4, len(right)))
    def read(data: bytes, at: int) -> None:
        # Cyclone DDS drops bytes that cannot be a message; our code gets all others.
        with suppress(DDSException):
            writer.write(sample(ros.JOINT_TRAJECTORY, right[:at] + data + right[at + len(data) :]))
        for message, _ in reader.take():
            if message is not None:
                with suppress(UsageError):
                    waypoints_of(message, numbers_of(TABLE, "joints"))

    read()


def test_another_process_finds_the_arm_on_this_computer_until_ctrl_c(server: PtyServer) -> None:
    domain = next(DOMAINS)
    # The domain is configured as ROS 2 does for ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST.
    local = Domain(domain, LOCALHOST)
    reader = Participant(domain).reader("rt/joint_states", ros.JOINT_STATE)
    words = ["ros2", server.url, "--domain", domain, "--allow-motion"]
    with started(*map(str, words)) as process:
        assert asyncio.run(received(reader)).name == NAMES
        process.send_signal(signal.SIGINT)
        assert process.wait(10) == 0
        assert process.stdout is not None
        topics = "/joint_states, /tf, /diagnostics, /joint_trajectory"
        assert process.stdout.read() == f"domain {domain} on this computer: {topics}\n"
    del local


def test_other_computers_find_the_arm_only_if_the_user_says_so() -> None:
    reach = "ROS_AUTOMATIC_DISCOVERY_RANGE"
    assert dds.network(None, {})[::2] == ("this computer", True)
    assert dds.network(None, {reach: "LOCALHOST"})[::2] == ("this computer", True)
    assert dds.network(None, {"ROS_LOCALHOST_ONLY": "1"})[::2] == ("127.0.0.1", True)
    for chosen in ({reach: "SUBNET"}, {"ROS_LOCALHOST_ONLY": "0"}):
        assert dds.network(None, chosen)[::2] == ("the default network", False)
    assert dds.network("eth0", {"ROS_LOCALHOST_ONLY": "1"})[::2] == ("eth0", False)
    with pytest.raises(UsageError, match=f"{reach} is 'OFF'; allowed: LOCALHOST, SUBNET"):
        dds.network(None, {reach: "OFF"})


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--domain", "233"], "233 is not in the range 0<=x<=232"),
        (["--rate", "0"], "rate is 0"),
        (["--interface", '"/><x'], "DDS on"),
    ],
)
def test_wrong_options_end_before_a_byte_is_sent(words: list[str], text: str) -> None:
    result = cobotwire("ros2", "loop://", *words)
    assert result.returncode in (2, 3)
    assert text in result.stderr
