"""The maker's older class for the myCobot.

It sends requests of the document's edition, and some that only newer firmware has.
"""

from __future__ import annotations

from robots.robot import GPIO, LOCAL, SERVO_BUS, Arguments, Call, Robot, Ruling

_ZERO = [0] * 6
_LIMITS = "this edition states no limits of the joints; the maker checks those of a 280"
_FREE = "a query or a reference is not a motion; the maker applies the limits of motion"
_ZERO_SPEED = Ruling("speed is 0", "a speed of 0 is legal in this edition; the maker wants 1..100")
_SIGN = Ruling(
    "'h' format", "the document's sign rule: words reach to 33000; the maker packs -32768..32767"
)
_PORT = Ruling("'h' format", "a port is 1..65535; the maker packs a signed word")
_RETRIED = "the maker sends the frame and the text up to three times, without an acknowledgement"
_RANGE = [Ruling("angle value", _LIMITS), _ZERO_SPEED]
_BYTE = "0x3A: no speed byte in this edition; mycobot280 has one"
_FORWARD = "0x23 has no data here; with six words it is mycobot280's forward kinematics"
_EVERY = "0x57: joints are 1..6; newer firmware takes 0 as all of them"
_MODE = "0x25: LEN 10 with a mode here; newer firmware also takes LEN 0F without"
_TRAILING = "this edition has no such trailing byte; mycobot280 has it as an optional one"
_WITH_ANOTHER_BYTE: dict[str, Arguments] = {
    "release_all_servos": (),
    "release_servo": (1,),
    "set_gripper_state": (0, 50),
    "set_gripper_value": (9, 50),
    "get_servo_data": (1, 24),
    "set_servo_data": (1, 24, 9),
}
_REFERENCES = ("tool_reference", "world_reference", "reference_frame", "end_type")
ROBOT = Robot(
    "MyCobot",
    "mycobot",
    ("mycobot280", "mypalletizer260"),
    local=LOCAL | GPIO | SERVO_BUS,
    lacking=dict.fromkeys(
        ["set_free_mode", "is_free_mode", "set_fresh_mode", "get_speed", "set_speed"]
        + ["jog_absolute", "jog_stop", "set_joint_min", "set_joint_max", "set_pin_mode"]
        + ["get_gripper_value", "is_gripper_moving"]
        + [f"get_{what}" for what in _REFERENCES]
        + [f"set_{what}" for what in _REFERENCES],
        "the class has no such method",
    ),
    calls=[
        Call("go_home", (), "send_angles", (_ZERO, 10)),
        Call("send_angle", (1, 0, 0), "send_angle", (1, 0, 0)),
        Call("send_angles", (_ZERO, 0), "send_angles", (_ZERO, 0)),
        Call("sync_send_angles", (_ZERO, 50), "send_angles", (_ZERO, 50)),
        Call("sync_send_coords", (_ZERO, 50, 1), "send_coords", (_ZERO, 50, 1)),
        Call("set_encoder", (4, 9, 50), "set_encoder", (4, 9), why=_BYTE),
        Call("angles_to_coords", (_ZERO,), "get_coords", (), why=_FORWARD),
        Call("focus_all_servos", (), "focus_servo", (6,), why=_EVERY),
        Call("send_coords", (_ZERO, 50), "send_coords", (_ZERO, 50, 0), why=_MODE),
        *(
            Call(method, (*given, 1), method, given, why=_TRAILING)
            for method, given in _WITH_ANOTHER_BYTE.items()
        ),
    ],
    rulings={
        "is_in_position": [Ruling("Has invalid", _FREE), _SIGN],
        "jog_angle": [_ZERO_SPEED],
        "jog_coord": [_ZERO_SPEED],
        "jog_increment": [_ZERO_SPEED, _SIGN],
        "send_angle": _RANGE,
        "send_angles": _RANGE,
        "send_coord": [_ZERO_SPEED, _SIGN],
        "send_coords": [_ZERO_SPEED, _SIGN],
        "set_encoders": [_ZERO_SPEED],
        "set_gripper_state": [_ZERO_SPEED],
        "set_encoder": [Ruling("missing 1 required positional argument: 'speed'", _BYTE)],
        "set_server_port": [_PORT],
        "set_ssid_pwd": [Ruling("fe fe 02 b0 fa fe fe 02 b0 fa", _RETRIED)],
    },
)
