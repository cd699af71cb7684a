"""A wrong argument is reported before a byte is sent."""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from cobotwire import MyCobot, MyCobot280, UsageError
from cobotwire.client import Client
from cobotwire.transport import Transport
from recording_transport import RecordingTransport

SIX = [0.0] * 6

BAD: list[tuple[str, Callable[[Any], Any], str, str]] = [
    ("five angles", lambda arm: arm.send_angles(SIX[:5], 20), "len(angles)", "6 numbers"),
    ("seven angles", lambda arm: arm.send_angles([0] * 7, 20), "len(angles)", "6 numbers"),
    (
        "an angle too large",
        lambda arm: arm.send_angles([0, 330.01, *SIX[2:]], 20),
        "angles.j2",
        "330",
    ),
    ("an angle too low", lambda arm: arm.send_angle(1, -325.36, 20), "angle", "-325.35"),
    ("NaN", lambda arm: arm.send_angles([0, 0, math.nan, 0, 0, 0], 20), "angles.j3", ".."),
    ("infinity", lambda arm: arm.send_angle(1, math.inf, 20), "angle", ".."),
    ("a string for an angle", lambda arm: arm.send_angle(1, "10", 20), "angle", "a number"),
    ("None for an angle", lambda arm: arm.send_angle(1, None, 20), "angle", "a number"),
    ("a string for a row", lambda arm: arm.send_angles("000000", 20), "angles", "6 numbers"),
    ("a number for a row", lambda arm: arm.send_angles(5, 20), "angles", "6 numbers"),
    ("joint 0", lambda arm: arm.send_angle(0, 0, 20), "joint", "1..6"),
    ("joint 7", lambda arm: arm.get_encoder(7), "joint", "1..6"),
    ("joint 1.5", lambda arm: arm.send_angle(1.5, 0, 20), "joint", "a whole number"),
    ("joint True", lambda arm: arm.send_angle(True, 0, 20), "joint", "a whole number"),
    ("NumPy's boolean", lambda arm: arm.send_angle(1, np.bool_(True), 20), "angle", "a number"),
    ("NumPy's, in a row", lambda arm: arm.send_angles([np.True_] * 6, 20), "angles.j1", ".."),
    ("an array of one", lambda arm: arm.send_angle(1, np.array(True), 20), "angle", "a number"),
    ("speed 101", lambda arm: arm.send_angles(SIX, 101), "speed", "0..100 percent"),
    ("speed -1", lambda arm: arm.set_speed(-1), "speed", "0..100 percent"),
    ("an unknown enum", lambda arm: arm.set_reference_frame(2), "frame", "BASE (0), WORLD (1)"),
    ("a string for an enum", lambda arm: arm.set_end_type("TOOL"), "end", "FLANGE (0), TOOL (1)"),
    ("axis 0", lambda arm: arm.send_coord(0, 10.0, 20), "axis", "X (1), Y (2), Z (3)"),
    ("2 for a flag", lambda arm: arm.set_free_mode(2), "free", "True or False"),
    ("a huge number", lambda arm: arm.set_server_port(10**400), "port", "1..65535"),
    ("a huge angle", lambda arm: arm.send_angle(1, 10**400, 20), "angle", "330"),
    ("encoder 4096", lambda arm: arm.set_encoder(1, 4096), "encoder", "0..4095 tick"),
    ("colour 256", lambda arm: arm.set_color(0, 256, 0), "green", "0..255"),
    (
        "x beyond the wire",
        lambda arm: arm.send_coords([3300.1, 0, 0, 0, 0, 0], 20, 1),
        "coords.x",
        "3300",
    ),
]


@pytest.mark.parametrize("codec", ["reference", "native"])
@pytest.mark.parametrize(
    "angle", [np.float32(0.5), np.float16(0.5), np.float64(0.5), Fraction(1, 2), Decimal("0.5")]
)
def test_radians_of_any_number_type_become_degrees(codec: Any, angle: Any) -> None:
    transport = RecordingTransport()
    MyCobot280(transport, codec=codec).send_radians([angle, 0, 0, 0, 0, 0], 10)
    assert transport.written[4:6] == round(100 * math.degrees(0.5)).to_bytes(2, "big")


@pytest.mark.parametrize("codec", ["reference", "native"])
@pytest.mark.parametrize(
    "angle", [True, np.True_, 10**400, math.nan, "1", None, np.array([1.0, 2.0])]
)
def test_radians_that_are_no_number_are_rejected(codec: Any, angle: Any) -> None:
    transport = RecordingTransport()
    with pytest.raises(UsageError, match=r"radians"):
        MyCobot280(transport, codec=codec).send_radians([angle, 0, 0, 0, 0, 0], 10)
    assert transport.written == b""


@pytest.mark.parametrize("codec", ["reference", "native"])
@pytest.mark.parametrize(
    ("call", "argument", "allowed"), [b[1:] for b in BAD], ids=[b[0] for b in BAD]
)
def test_wrong_argument_is_named_and_nothing_is_written(
    codec: Any, call: Callable[[Any], Any], argument: str, allowed: str
) -> None:
    transport = RecordingTransport()
    assert isinstance(transport, Transport)
    with MyCobot(transport, codec=codec) as arm:
        with pytest.raises(UsageError) as caught:
            call(arm)
        assert caught.value.argument == argument
        assert allowed in caught.value.allowed
        assert argument in str(caught.value)
        assert transport.written == b""
        # No request is left waiting, so the next call is sent.
        arm.power_on()
    assert transport.written == bytes.fromhex("FEFE0210FA")


def test_usage_error_is_a_value_error() -> None:
    with pytest.raises(ValueError, match=r"speed is 101; allowed: a whole number 0\.\.100 percent"):
        MyCobot(RecordingTransport()).send_angles(SIX, 101)


@pytest.mark.parametrize(
    ("options", "argument"),
    [
        ({"port": ""}, "port"),
        ({"port": 5}, "port"),
        ({"port": "nosuch://thing"}, "port"),
        *[
            ({"port": "loop://", "baudrate": wrong}, "baudrate")
            for wrong in (True, 0, -1, 2**31, 10**30, 9600.0, "9600")
        ],
        *[({"port": "loop://", "timeout": wrong}, "timeout") for wrong in (True, 0, math.nan)],
        *[({"port": "loop://", "codec": wrong}, "codec") for wrong in ("foo", "", 5, ["native"])],
    ],
)
def test_wrong_option_is_named(options: dict[str, Any], argument: str) -> None:
    with pytest.raises(UsageError) as caught:
        MyCobot(**options)
    assert caught.value.argument == argument


def test_unknown_codec_in_the_environment_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COBOTWIRE_CODEC", "fast")
    with pytest.raises(
        UsageError, match="COBOTWIRE_CODEC is 'fast'; allowed: native, reference, or unset"
    ):
        Client.__init__(MyCobot.__new__(MyCobot), RecordingTransport())
