"""The Mercury, the Pro 400 and the Pro 630, which report the end of a motion."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from robots.opening import SINGLE, opened_as
from robots.robot import LOCAL, Call, Robot

_PRO = {"angle": (11, 12), "torque": (27, 28), "speed": (32, 33)}
_HAND = {"angle": (11, 12), "torque": (27, 28), "p": (15, 16), "d": (17, 18), "i": (19, 20)}
_HAND |= {"clockwise": (21, 22), "counterclockwise": (23, 24), "min_pressure": (25, 26)}
# Methods for one register of a tool; ours are the commands for any register.
_TOOLS = [
    *(
        Call(f"set_pro_gripper_{what}", (50,), "set_pro_gripper", (at, 50))
        for what, (at, _) in _PRO.items()
    ),
    *(
        Call(f"get_pro_gripper_{what}", (), "get_pro_gripper", (at,))
        for what, (_, at) in _PRO.items()
    ),
    *(
        Call(f"set_hand_gripper_{w}", (2, 5), "set_hand_gripper", (at, 2, 5))
        for w, (at, _) in _HAND.items()
    ),
    *(
        Call(f"get_hand_gripper_{w}", (6,), "get_hand_gripper", (at, 6))
        for w, (_, at) in _HAND.items()
    ),
    Call("set_hand_gripper_speed", (1, 100), "set_hand_gripper", (32, 1, 100)),
    Call("get_hand_gripper_default_speed", (1,), "get_hand_gripper", (33, 1)),
    Call("set_pro_gripper_abs_angle", (100,), "set_pro_gripper", (36, 100)),
    Call("set_pro_gripper_open", (), "set_pro_gripper", (11, 100)),
    Call("set_pro_gripper_close", (), "set_pro_gripper", (11, 0)),
    Call("set_pro_gripper_calibration", (), "set_pro_gripper", (13, 0)),
    Call("set_pro_gripper_pause", (), "set_pro_gripper", (37, 0)),
    Call("set_pro_gripper_resume", (), "set_pro_gripper", (38, 0)),
    Call("set_pro_gripper_stop", (), "set_pro_gripper", (39, 0)),
    Call("get_pro_gripper_status", (), "get_pro_gripper", (14,)),
    Call("set_hand_gripper_id", (15,), "set_pro_gripper", (3, 15)),
    Call("get_hand_gripper_id", (), "get_hand_gripper", (4,)),
    Call("set_hand_gripper_calibrate", (1,), "set_pro_gripper", (13, 1)),
    Call("set_hand_gripper_enabled", (1,), "set_pro_gripper", (10, 1)),
    Call("get_hand_gripper_status", (), "get_hand_gripper", (14, 0)),
    Call("get_hand_firmware_major_version", (), "get_hand_gripper", (1, 0)),
    Call("get_hand_firmware_minor_version", (), "get_hand_gripper", (2, 0)),
    Call("get_hand_model", (), "get_hand_gripper", (53, 0)),
    Call(
        "set_hand_gripper_angles",
        ([1, 2, 3, 4, 5, 6], 50),
        "set_hand_gripper_angles",
        ([1, 2, 3, 4, 5, 6], 50),
    ),
    Call("get_hand_gripper_angles", (), "get_hand_gripper", (50, 0)),
    # The two arguments are bytes, and the request has them as one word.
    Call(
        "set_hand_gripper_pinch_action_speed_consort", (4, 5), "set_pro_gripper", (52, 4 * 256 + 5)
    ),
]
_HOME = [0, 0, 0, 0, 0, 90, 0]
_PLACE = [300, 0, 200, 90, 0, -90]


def _calls_of(joints: int) -> list[Call]:
    """Return the calls of methods without a command of the same name."""
    zero = [0] * joints
    return [
        *_TOOLS,
        Call("clear_encoders_error", (joints,), "clear_encoder_error", (joints,)),
        Call("set_servos_calibration", (), "set_servo_calibration", (1,)),
        Call("go_home", (), "send_angles", (_HOME, 20)),
        Call("sync_send_angles", (zero, 50), "send_angles", (zero, 50)),
        Call("is_in_position", (_PLACE, 1), "is_in_position_coords", (_PLACE,)),
        Call("get_coords", (zero,), "angles_to_coords", (zero,)),
    ]


# On a port that is not one of two arms, the class refuses these before it sends anything.
_TWO_ARMS = {"get_base_coords", "send_base_coord", "send_base_coords", "jog_base_coord"}
_TWO_ARMS |= {"jog_base_increment_coord", "jog_base_rpy", "set_servo_cw", "get_servo_cw"}
_TWO_ARMS |= {"clear_waist_queue"}
_SHARED: dict[str, Any] = {
    "lacking": {
        "angles_to_coords": "get_coords with angles",
        "is_in_position_coords": "is_in_position with the mode 1",
        "set_hand_gripper": "a method for each register",
        "get_hand_gripper": "a method for each register",
    },
    "own_arguments": {
        "set_pro_gripper": [(3, 254), (10, 1), (11, 0), (11, 100), (43, 300)],
        "tool_serial_write_data": [([1, 2, 3],), ([255] * 45,)],
        "get_pro_gripper": [(1, 14), (4, 1), (44, 254)],
    },
}
_A1 = Robot(
    "Mercury (A1)",
    "mercury_a1",
    further=("mercury_b1",),
    local=LOCAL | _TWO_ARMS,
    calls=_calls_of(7),
    opened=opened_as(SINGLE),
    **_SHARED,
)
_BODY = "is_in_position_base_coords"
# The left arm of a Mercury B1 or X1.
_B1 = replace(
    _A1,
    peer="Mercury (B1, X1)",
    edition="mercury_b1",
    further=(),
    local=LOCAL,
    lacking={**_A1.lacking, _BODY: "is_in_position with the mode 2"},
    calls=[*_A1.calls, Call("is_in_position", (_PLACE, 2), _BODY, (_PLACE,))],
    opened=opened_as("/dev/left_arm"),
)
_400 = replace(_A1, peer="Pro400", edition="pro400", local=LOCAL, calls=_calls_of(6))
# These switch pins of the computer in the arm, or raise an error: the robot does not support them.
_PINS = {"get_basic_input", "set_basic_output", "power_on_only"}
_PINS |= {"get_monitor_mode", "set_monitor_mode"}
_ZERO = [0] * 6
_630 = replace(
    _400,
    peer="Pro630",
    edition="pro630",
    calls=[*_400.calls, Call("send_angles_sync", (_ZERO, 50), "send_angles", (_ZERO, 50))],
    local=LOCAL | _PINS,
    own_arguments={**_400.own_arguments, "power_on": [(1,)]},
)
ROBOTS = (_A1, _B1, _400, _630)
