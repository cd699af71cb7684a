"""A client with other limits rejects a target beyond them before it sends a byte."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from both_ways import openers
from cobotwire import Limits, ReplyTimeout, UsageError, editions
from cobotwire import codec as codecs
from cobotwire.client.opening import settings as client_settings
from cobotwire.editions.mercury_a1 import MercuryA1
from cobotwire.editions.mycobot import TABLE as DOCUMENT
from cobotwire.editions.mycobot import MyCobot
from cobotwire.editions.mycobot280 import TABLE, AsyncMyCobot280, MyCobot280
from cobotwire.kinematics import coords_of, geometry_of
from cobotwire.protocol.effects import Moves, effect_of
from cobotwire.protocol.limits import limited
from cobotwire.protocol.refusals import refusals
from cobotwire.protocol.roles import moves_arm
from cobotwire.protocol.table import Table
from recording_transport import RecordingTransport
from strategies import codec_of, legal_values, variants_of

REST: list[Any] = [None] * 5
NAMES: list[codecs.CodecName] = ["reference", "native"]


@pytest.mark.parametrize("codec", NAMES)
@pytest.mark.parametrize("client", [MyCobot, MyCobot280])
def test_narrower_limits_apply_to_every_call_with_a_target(
    client: type[MyCobot280], codec: codecs.CodecName
) -> None:
    transport = RecordingTransport()
    arm = client(transport, codec=codec, limits=Limits([(-90, 45.5), *REST], [*REST, (0, 10)]))
    for angle in (45.51, -90.01):
        with pytest.raises(UsageError, match=r"-90\.\.45\.5"):
            arm.send_angles([angle, 0, 0, 0, 0, 0], 20)
        with pytest.raises(UsageError, match=r"-90\.\.45\.5"):
            arm.send_angle(1, angle, 20)
    with pytest.raises(UsageError, match=r"0\.\.10"):
        arm.send_coord(6, 10.01, 20)
    with pytest.raises(UsageError, match=r"0\.\.10"):
        arm.send_coords([0, 0, 0, 0, 0, -0.01], 20, 1)
    assert transport.written == b""
    arm.send_angle(1, 45.5, 20)
    arm.send_angle(2, 100, 20)
    arm.send_coord(6, 10, 20)
    assert transport.written == bytes.fromhex(
        "FE FE 06 21 01 11 C6 14 FA FE FE 06 21 02 27 10 14 FA FE FE 06 24 06 03 E8 14 FA"
    )


def test_limits_apply_in_radians_and_to_jogging() -> None:
    transport = RecordingTransport()
    with pytest.raises(UsageError):
        MyCobot280(transport, limits=Limits([(-90, 90), *REST])).send_radians(
            [math.pi * 0.51, 0, 0, 0, 0, 0], 20
        )
    with pytest.raises(UsageError):
        MyCobot(transport, limits=Limits([(-90, 90), *REST])).jog_absolute(1, 91, 20)
    assert transport.written == b""


def test_limits_of_joints_hold_for_encoders_and_motions_without_targets() -> None:
    transport = RecordingTransport()
    arm = MyCobot280(transport, limits=Limits([(-5, 5), *REST]))
    calls: list[tuple[Callable[[], Any], str]] = [
        (lambda: arm.set_encoders([3072] * 6, 20), "its target is in encoder ticks"),
        (lambda: arm.set_encoder(1, 3072, 20), "its target is in encoder ticks"),
        (lambda: arm.set_encoders_drag([3072] * 6, [9] * 6), "its target is in encoder ticks"),
        (lambda: arm.move_round(), "its target is outside of it or unknown"),
    ]
    for call, error in calls:
        with pytest.raises(UsageError, match=error):
            call()
    assert transport.written == b""
    arm.jog_increment(1, 90, 20)
    arm.stop()
    unlimited = MyCobot280(transport, limits=Limits([None] * 6))
    unlimited.set_encoders([3072] * 6, 20)
    assert transport.written.count(b"\xfe\xfe") == 3


@pytest.mark.parametrize(
    ("edition", "name", "arguments"),
    [("mybuddy", "send_angles_auto", (50,)), ("myarm_m750", "set_joints_angle", (50,))],
)
def test_limits_hold_for_each_row_of_angles(edition: str, name: str, arguments: Any) -> None:
    table = EVERY[edition]
    joints = len(table.in_role("joint targets").request[0].fields[0].numbers)
    limits = Limits([(-5, 5), *[None] * (joints - 1)])
    encoder = client_settings(table, None, None, "native", limits).encoder(None)
    encoder.encode(name, ([5.0] + [0.0] * (joints - 1), *arguments))
    with pytest.raises(UsageError, match=r"j1 is 5\.1; allowed: a number -5\.\.5"):
        encoder.encode(name, ([5.1] + [0.0] * (joints - 1), *arguments))


@pytest.mark.parametrize(("lowest", "within"), [(-10, True), (1, False)])
def test_motion_to_zero_is_refused_if_a_joint_excludes_zero(lowest: float, within: bool) -> None:
    found = refusals(EVERY["pro630"], Limits([(lowest, 10), *REST]))
    assert "drag_teach_execute" in found
    assert ("over_limit_return_zero" in found) is not within


def test_limits_of_coordinates_hold_for_both_ends_of_an_arc() -> None:
    limits = Limits(coords=[(-100, 100), *REST])
    encoder = client_settings(EVERY["pro630"], None, None, "native", limits).encoder(None)
    inside, outside = [100.0, 0, 0, 0, 0, 0], [100.5, 0, 0, 0, 0, 0]
    encoder.encode("write_move_c", (inside, inside, 20))
    for points in ((inside, outside), (outside, inside)):
        with pytest.raises(UsageError, match=r"x is 100\.5; allowed: a number -100\.\.100"):
            encoder.encode("write_move_c", (*points, 20))


@pytest.mark.parametrize("codec", NAMES)
def test_wider_limits_must_be_explicit_and_fit_the_wire(codec: codecs.CodecName) -> None:
    wide: list[Any] = [(-200, 200), *REST]
    with pytest.raises(UsageError, match=r"inside -168\.\.168 degrees.*wider=True") as caught:
        MyCobot280(RecordingTransport(), limits=Limits(wide))
    assert caught.value.argument == "limits.joints[0]"
    transport = RecordingTransport()
    MyCobot280(transport, codec=codec, limits=Limits(wide, wider=True)).send_angle(1, -200, 20)
    assert transport.written == bytes.fromhex("FE FE 06 21 01 B1 E0 14 FA")
    with pytest.raises(UsageError, match=r"-327\.68\.\.327\.67 degrees, the limits of the wire"):
        MyCobot280(RecordingTransport(), limits=Limits([(-400, 0), *REST], wider=True))


@pytest.mark.parametrize(
    ("ranges", "argument"),
    [
        ([(0, 1)], "len(limits.joints)"),
        ([(1, 0), *REST], "limits.joints[0]"),
        ([(0, math.nan), *REST], "limits.joints[0]"),
        ([(0, math.inf), *REST], "limits.joints[0]"),
        ([(0, 1e308), *REST], "limits.joints[0]"),
        ([(True, False), *REST], "limits.joints[0]"),
        ([None, "90", *REST[1:]], "limits.joints[1]"),
        ([5, *REST], "limits.joints[0]"),
        ("000000", "limits.joints"),
        (5, "limits.joints"),
    ],
)
def test_wrong_limit_is_named(ranges: Any, argument: str) -> None:
    with pytest.raises(UsageError) as caught:
        MyCobot280(RecordingTransport(), limits=Limits(ranges))
    assert caught.value.argument == argument


def test_lasting_writes_are_refused_within_a_speed_and_allowed_without() -> None:
    within, without = RecordingTransport(), RecordingTransport()
    with pytest.raises(UsageError, match="its effect is permanent"):
        MyCobot280(within, limits=Limits(speed=30)).set_joint_max(1, 90)
    MyCobot280(without).set_joint_max(1, 90)
    assert within.written == b""
    assert without.written != b""


@pytest.mark.parametrize("mode", [0, 1])
def test_highest_speed_is_not_set_within_a_speed(mode: int) -> None:
    transport = RecordingTransport()
    with pytest.raises(UsageError, match="it changes what a percentage means"):
        MercuryA1(transport, limits=Limits(speed=1)).set_max_speed(mode, 150)
    assert transport.written == b""
    limits = Limits(workspace=BOX)
    client_settings(EVERY["pro450"], None, None, "native", limits).encoder(None).encode(
        "set_max_speed", (mode, 150)
    )


@given(
    st.sampled_from(NAMES),
    st.sampled_from([TABLE, DOCUMENT]),
    st.integers(0, 5),
    st.floats(-140, 139),
    st.floats(0, 1),
    st.floats(-200, 200),
)
def test_encoded_target_is_within_the_limits(
    name: codecs.CodecName, table: Any, joint: int, lowest: float, width: float, angle: float
) -> None:
    ranges: list[Any] = [None] * 6
    ranges[joint] = (lowest, lowest + width)
    try:
        codec = codecs.load(limited(table, Limits(ranges)), name)
    except UsageError:
        # The limits are too narrow: no raw value is inside them.
        assert width < 0.01
        return
    target = [0.0] * 6
    target[joint] = angle
    try:
        frame = codec.encode("send_angles", "request", (target, 20))
    except UsageError:
        return
    sent = codec.decode("request", frame).fields["angles"][joint]
    assert lowest <= sent <= lowest + width


BOX: list[Any] = [(-300, 300), (-300, 300), (50, 500)]
EVERY = {name: editions.load(name).TABLE for name in editions.names()}
SPEED = st.none() | st.floats(1, 100)
SIDE = st.none() | st.tuples(st.floats(-600, 0), st.floats(0, 600))


class FrameTransport(RecordingTransport):
    """Replies to the queries of the frame, which it does not record, and to nothing else."""

    def __init__(self, table: Table, frame: int = 0, end: int = 0) -> None:
        super().__init__()
        codec, self._incoming = codecs.load(table, "reference"), b""
        self._replies = {
            codec.encode(name, "request", ()): codec.encode(name, "reply", (value,))
            for name, value in (("get_reference_frame", frame), ("get_end_type", end))
        }

    def write(self, data: bytes) -> None:
        if (reply := self._replies.get(data)) is None:
            super().write(data)
        else:
            self._incoming += reply

    def read(self, timeout: float) -> bytes:
        data, self._incoming = self._incoming, b""
        return data


@pytest.mark.parametrize("way", ["blocking", "asyncio"])
@pytest.mark.parametrize(("frame", "end"), [(1, 0), (0, 1)])
def test_workspace_refuses_coordinates_in_another_frame(way: str, frame: int, end: int) -> None:
    transport = FrameTransport(TABLE, frame, end)
    query = "get_reference_frame" if frame else "get_end_type"
    with openers(MyCobot280, AsyncMyCobot280)[way](transport, limits=Limits(workspace=BOX)) as arm:
        calls: list[Callable[[], Any]] = [
            lambda: arm.send_coords([100, 0, 100, 0, 0, 0], 20, 1),
            lambda: arm.send_coord(3, 100, 20),
            lambda: arm.move_coords([100, 0, 100, 0, 0, 0], 20),
        ]
        for call in calls:
            with pytest.raises(UsageError, match=rf"{query}\(\) reports 1"):
                call()
        assert transport.written == b""
        arm.send_angles([0] * 6, 20)
        arm.stop()
    assert transport.written.count(b"\xfe\xfe") == 2


def test_workspace_refuses_coordinates_if_the_frame_is_not_reported() -> None:
    transport = RecordingTransport()
    arm = MyCobot280(transport, limits=Limits(workspace=BOX), timeout=0.05)
    with pytest.raises(ReplyTimeout, match="get_reference_frame"):
        arm.send_coords([100, 0, 100, 0, 0, 0], 20, 1)
    assert transport.written.startswith(bytes.fromhex("FE FE 02 86 FA"))
    assert bytes([0xFE, 0xFE, 0x10, 0x25]) not in transport.written


def test_target_is_not_sent_after_a_stop_that_comes_while_the_frame_is_read() -> None:
    class Stopping(FrameTransport):
        stopped = False

        def read(self, timeout: float) -> bytes:
            if self._incoming and not self.stopped:
                self.stopped = True
                arm.stop()
            return super().read(timeout)

    transport = Stopping(TABLE)
    arm = MyCobot280(transport, limits=Limits(workspace=BOX))
    with pytest.raises(UsageError, match="the arm was stopped while its frame was read"):
        arm.send_coords([100, 0, 100, 0, 0, 0], 20, 1)
    assert transport.written == bytes.fromhex("FE FE 02 29 FA")
    arm.send_coords([100, 0, 100, 0, 0, 0], 20, 1)
    assert transport.written.count(b"\xfe\xfe") == 2


@pytest.mark.parametrize("way", ["blocking", "asyncio"])
def test_speed_and_workspace_are_checked_before_a_byte_is_sent(way: str) -> None:
    transport = FrameTransport(TABLE)
    limits = Limits(speed=30, workspace=BOX)
    with openers(MyCobot280, AsyncMyCobot280)[way](transport, limits=limits) as arm:
        refused: list[tuple[Callable[[], Any], str]] = [
            (lambda: arm.send_angles([0] * 6, 31), r"speed is 31; allowed: .* 1\.\.30 percent"),
            (lambda: arm.set_gripper_value(50, 31), r"speed is 31"),
            (lambda: arm.send_angles([0, -130, 0, 0, 0, 0], 30), r"allows z 50\.\.500 mm"),
            (
                lambda: arm.send_radians([0, -2.27, 0, 0, 0, 0], 30),
                r"the end of the arm to z -?\d+",
            ),
            (lambda: arm.move_angles([0, -130, 0, 0, 0, 0], 30), r"z 50\.\.500"),
            (lambda: arm.send_coord(3, 49.9, 30), r"coord is 49\.9; allowed: a number 50\.\."),
            (lambda: arm.send_coords([0, 0, 49, 0, 0, 0], 30, 0), r"coords\.z is 49; allowed: "),
            (lambda: arm.send_angle(1, 0, 30), r"send_angle\(\) is refused: limits\.workspace"),
            (lambda: arm.jog_coord(1, 1, 30), r"unknown where the end of the arm would go"),
            (lambda: arm.set_tool_reference([0] * 6), r"changes what coordinates mean"),
            (lambda: arm.move_round(), r"refused"),
        ]
        for call, error in refused:
            with pytest.raises(UsageError, match=error):
                call()
        assert transport.written == b""
        arm.send_angles([0] * 6, 30)
        arm.send_coord(3, 50, 30)
        arm.set_gripper_value(50, 30)
        arm.resume()
        arm.stop()
    assert transport.written.endswith(bytes.fromhex("FE FE 02 29 FA"))
    assert transport.written.count(b"\xfe\xfe") == 5


@pytest.mark.parametrize(
    ("limits", "argument"),
    [
        (Limits(speed=0.9), "limits.speed"),
        (Limits(speed=101), "limits.speed"),
        (Limits(speed=True), "limits.speed"),
        (Limits(speed=math.nan), "limits.speed"),
        (Limits(workspace=BOX[:2]), "len(limits.workspace)"),
        (Limits(workspace=[*BOX[:2], (5, 4)]), "limits.workspace[2]"),
        (Limits(workspace=[*BOX[:2], (9000, 9001)]), "limits.workspace[2]"),
    ],
)
def test_wrong_speed_or_workspace_is_named(limits: Limits, argument: str) -> None:
    with pytest.raises(UsageError) as caught:
        MyCobot280(RecordingTransport(), limits=limits)
    assert caught.value.argument == argument


def test_edition_without_geometry_refuses_targets_of_joints_in_a_workspace() -> None:
    transport = FrameTransport(EVERY["mercury_a1"])
    arm = MercuryA1(transport, limits=Limits(workspace=BOX))
    with pytest.raises(UsageError, match="edition mercury_a1 states no geometry"):
        arm.send_angles([0, 0, 0, -90, 0, 90, 0], 20)
    assert transport.written == b""
    arm.send_coords([100, 0, 100, 0, 0, 0], 20)
    assert transport.written


@given(st.sampled_from(sorted(EVERY)), SPEED, st.none() | st.tuples(SIDE, SIDE, SIDE), st.data())
@settings(max_examples=150)
def test_no_encoded_request_exceeds_a_speed_or_leaves_a_workspace(
    name: str, speed: float | None, workspace: Any, data: st.DataObject
) -> None:
    table = EVERY[name]
    limits = Limits(speed=speed, workspace=workspace)
    if workspace is not None and table.find_role("coordinate targets") is None:
        with pytest.raises(UsageError, match="no command with the role 'coordinate targets'"):
            client_settings(table, None, None, "reference", limits)
        return
    sending = client_settings(table, None, None, "reference", limits)
    moving = [
        each
        for each in variants_of(table)
        if each.direction == "request" and each.command.safety == "motion"
    ]
    # Half of the draws are joint targets, which are only a few of the motions.
    targets = [each for each in moving if each.command.role in ("joint targets", "joint target")]
    often: bool = data.draw(st.booleans())
    moving = targets if targets and often else moving
    command, _, variant, number = moving[data.draw(st.integers(0, len(moving) - 1))]
    values = data.draw(legal_values(variant))
    try:
        frame = sending.encoder(None).encode(command.name, values, None, number).frame
    except UsageError:
        assert command.role not in ("stop", "halt")
        return
    fields = codec_of(name, "reference").decode("request", frame, of=command.name).fields
    if speed is not None and moves_arm(table, command):
        assert fields["speed"] <= speed
    if workspace is not None and moves_arm(table, command):
        for side, place in _places(table, command, fields, workspace):
            assert side is None or side[0] - 1e-9 <= place <= side[1] + 1e-9


def _places(table: Any, command: Any, fields: Any, workspace: Any) -> Any:
    """Yield each axis of the workspace to which a command sends the end, and where."""
    row = next((value for value in fields.values() if isinstance(value, tuple)), ())
    effect, geometry = effect_of(command), geometry_of(table)
    if command.role == "joint targets":
        assert geometry is not None, "without it the command is refused"
        return zip(workspace, coords_of(geometry, row))
    if command.role == "coordinate targets":
        return zip(workspace, row)
    assert isinstance(effect, Moves)
    assert command.role == "coordinate target", f"{command.name} could go anywhere"
    axis = fields[effect.about] - 1
    return [(workspace[axis], fields["coord"])] if axis < 3 else []
