"""List values for which pymycobot's request differs from ours although the command is equal."""

from __future__ import annotations

from typing import Any

from pymycobot_difference import ALL, BOTH, COBOT, M280, NOT_SENT, PALLETIZER, Row, same_call

_TRUNCATED = "encode: the nearest step (0.29 x100 is 29); pymycobot cuts off the rest (28)"
_ENCODER = "encoders are 0..4095; 4096 is accepted by pymycobot only"
_SIGNED = "signed words reach from -32535 to 33000 here; pymycobot packs -32768..32767"
_LIMIT = "0x4C 0x4D: any hundredth of a degree here; pymycobot takes whole degrees only"
_PORT = "the port is an unsigned word; pymycobot packs a signed one"
_SPEED = "speed is 0..100 in this edition; pymycobot wants 1..100, as mycobot280 does for motion"
_JOINT = "joints are 1..6; newer firmware has the gripper as 7"
_CLOSED = "the list is closed here: gripper 0 1, pin mode 0 1, free mode 0 1, registers 20..24"
_BYTE = (
    "0x52 writes 0..254; a value of two bytes has no variant here, and pymycobot none without mode"
)

_SIX = [0, 0, 0, 0, 0, 0.29]
_SIX_READ = (0, 0, 0, 0, 0, 0.28)
_OFF_STEP = [12.37, 0, 0, 0, 0, 0.29]
_OFF_STEP_READ = (12.3, 0, 0, 0, 0, 0.28)


def _cut(peers: tuple[str, ...], command: str, given: tuple[Any, ...], *read: Any) -> Row:
    topic = "12.37 millimetres" if 12.37 in given or _OFF_STEP in given else "0.29 degrees"
    return same_call(peers, command, topic, given, read, _TRUNCATED)


TRUNCATIONS = [
    _cut(ALL, "send_angle", (1, 0.29, 50), 1, 0.28, 50),
    _cut(BOTH, "send_angles", (_SIX, 50), _SIX_READ, 50),
    _cut(ALL, "send_coord", (4, 0.29, 50), 4, 0.28, 50),
    _cut(ALL, "send_coord", (1, 12.37, 50), 1, 12.3, 50),
    _cut(BOTH, "send_coords", (_SIX, 50, 1), _SIX_READ, 50, 1),
    _cut(BOTH, "send_coords", (_OFF_STEP, 50, 1), _OFF_STEP_READ, 50, 1),
    _cut(BOTH, "is_in_position", (_SIX, 0), _SIX_READ, 0),
    _cut(BOTH, "is_in_position", (_OFF_STEP, 1), _OFF_STEP_READ, 1),
    _cut((PALLETIZER,), "jog_absolute", (1, 0.29, 50), 1, 0.28, 50),
    _cut(ALL, "jog_increment", (1, -0.29, 50), 1, -0.28, 50),
]

REACH = [
    same_call(BOTH, "set_encoders", "4096", ([4096] * 6, 50), "bad-value", _ENCODER),
    # The sign rule of the document turns a step of -327 degrees into one of +328.36.
    same_call(ALL, "jog_increment", "-327 degrees", (1, -327, 50), (1, 328.36, 50), _SIGNED),
    same_call(ALL, "jog_increment", "328 degrees", (1, 328, 50), NOT_SENT, _SIGNED),
    same_call((M280,), "set_joint_min", "half a degree", (1, -12.5), NOT_SENT, _LIMIT),
    same_call((M280,), "set_joint_max", "half a degree", (1, 12.5), NOT_SENT, _LIMIT),
    same_call(ALL, "set_server_port", "above 32767", (40000,), NOT_SENT, _PORT),
    same_call(BOTH, "send_angles", "speed 0", (_SIX, 0), NOT_SENT, _SPEED),
    same_call(BOTH, "jog_angle", "speed 0", (1, 1, 0), NOT_SENT, _SPEED),
    same_call((COBOT,), "set_gripper_state", "speed 0", (0, 0), NOT_SENT, _SPEED),
    same_call(BOTH, "get_encoder", "the gripper", (7,), "bad-value", _JOINT),
    same_call((COBOT,), "focus_servo", "the gripper", (7,), "bad-value", _JOINT),
    same_call(ALL, "get_servo_data", "register 56", (1, 56), "bad-value", _CLOSED),
    same_call(ALL, "set_servo_data", "value 255", (1, 21, 255), "bad-value", _BYTE),
    same_call(ALL, "set_gripper_state", "release", (254, 50), "bad-value", _CLOSED),
    same_call((M280, PALLETIZER), "set_pin_mode", "pull-up", (23, 2), "bad-value", _CLOSED),
    same_call((M280, PALLETIZER), "set_free_mode", "254", (254,), "bad-value", _CLOSED),
]
