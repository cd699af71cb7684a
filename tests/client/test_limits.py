"""A client with other limits rejects a target beyond them before it sends a byte."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import Limits, UsageError
from cobotwire import codec as codecs
from cobotwire.editions.mycobot import TABLE as DOCUMENT
from cobotwire.editions.mycobot import MyCobot
from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.protocol.limits import limited
from recording_transport import RecordingTransport

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


@pytest.mark.parametrize("codec", NAMES)
def test_wider_limits_must_be_explicit_and_fit_the_wire(codec: codecs.CodecName) -> None:
    wide: list[Any] = [(-200, 200), *REST]
    with pytest.raises(UsageError, match=r"inside -168\.\.168 degrees.*wider=True") as caught:
        MyCobot280(RecordingTransport(), limits=Limits(wide))
    assert caught.value.argument == "limits.joints[0]"
    transport = RecordingTransport()
    MyCobot280(transport, codec=codec, limits=Limits(wide, wider=True)).send_angle(1, -200, 20)
    assert transport.written == bytes.fromhex("FE FE 06 21 01 B1 E0 14 FA")
    with pytest.raises(UsageError, match=r"-327\.68\.\.327\.67 degrees, what the wire carries"):
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


def test_limits_of_another_type_are_rejected() -> None:
    with pytest.raises(UsageError, match="limits is 5"):
        MyCobot280(RecordingTransport(), limits=5)  # type: ignore[arg-type]


def test_empty_limits_do_not_change_the_table() -> None:
    assert limited(TABLE, Limits()) == TABLE
    rows = Limits([None, *REST], [None, *REST])
    assert limited(TABLE, rows).command("send_angles") == TABLE.command("send_angles")


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
