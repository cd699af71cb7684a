"""The myPalletizer 260."""

from __future__ import annotations

from robots.robot import GEOMETRY, GPIO, LOCAL, Arguments, Call, Robot
from robots.rulings import NEAREST, SETTERS

_LIMITS = "0x21 0x22 0x24 0x25 0x31: the limits that the maker lists; its class does not apply them"
_JOINT = "joints are 1..4, as the maker lists them; its class checks 0..5, or nothing"
_SPEED = "0x41: a speed is 1..100, as the maker lists it; its class accepts 0"
_TENTH = "0x4C 0x4D: any tenth of a degree here; the maker takes whole degrees only"
_REGISTER = "0x52: registers 0 to 4 cannot be written, as on the 280; the maker does not check"
_FREE = "0x1A: free mode is on or off; the maker also sends 254"
_COUNT = "0x3C: as many encoders as joints, and a speed of 1..100; the maker checks neither"
_THREE = "0x22: the arm has four joints; the maker sends three angles"


def _differs(method: str, arguments: Arguments, why: str) -> Call:
    return Call(method, arguments, method, arguments, why=why)


_ZERO = [0, 0, 0, 0]
_LOWEST, _HIGHEST = [-162, -2, -92, -180], [162, 90, 60, 180]
ROBOT = Robot(
    "MyPalletizer260",
    "mypalletizer260",
    local=LOCAL | GPIO,
    calls=[
        Call("is_in_position", (_LOWEST,), "is_in_position", (_LOWEST, 0)),
        Call("set_color", (), "set_color", (0, 0, 0)),
        Call("sync_send_angles", (_HIGHEST, 50), "send_angles", (_HIGHEST, 50)),
        Call("sync_send_coords", ([200, 0, 100, 9], 50), "send_coords", ([200, 0, 100, 9], 50)),
        Call("go_home", (), "send_angles", (_ZERO, 10), why=_THREE),
        _differs("set_joint_min", (1, -90.5), _TENTH),
        _differs("set_joint_max", (1, 90.5), _TENTH),
        _differs("set_servo_data", (1, 4, 1), _REGISTER),
        _differs("send_angle", (1, 0.29, 50), NEAREST),
        _differs("send_angles", ([0, 91, 0, 0], 50), _LIMITS),
        _differs("send_coord", (1, 261, 50), _LIMITS),
        _differs("send_coords", ([0, 0, -16, 0], 50), _LIMITS),
        _differs("jog_absolute", (1, 163, 50), _LIMITS),
        _differs("jog_angle", (0, 1, 50), _JOINT),
        _differs("jog_increment", (5, 1, 50), _JOINT),
        _differs("set_speed", (0,), _SPEED),
        _differs("set_encoder", (5, 2048, 50), _JOINT),
        _differs("set_free_mode", (254,), _FREE),
        _differs("send_radians", ([1, 0.5, 0, 0], 50), NEAREST),
        _differs("set_encoders", ([1, 2, 3], 0), _COUNT),
    ],
    rulings=SETTERS,
    unanswered={"get_coords": GEOMETRY},
    kinds={"is_free_mode": list},
)
