"""The arms that do not report the end of a motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from robots.robot import Call, Robot

_ZERO = [0] * 6
_OLD = {"jog_stop": "a command of the edition mycobot, which the 280 keeps"}
_OTHER_NAME = "the older class for the 280 has the method"


def _same(method: str, *arguments: Any) -> Call:
    return Call(method, arguments, method, arguments)


def _home(joints: int = 6) -> Call:
    return Call("go_home", (), "send_angles", ([0] * joints, 10))


def _synchronous(angles: Sequence[float], coords: Sequence[float], *mode: int) -> list[Call]:
    """Return the calls that wait for their motions, with ``mode`` or without it."""
    return [
        Call("sync_send_angles", (angles, 50), "send_angles", (angles, 50)),
        Call("sync_send_coords", (coords, 50, *mode), "send_coords", (coords, 50, *(mode or (0,)))),
    ]


_LOWEST = [-168, -140, -150, -150, -155, -180]
# Header and footer inside the data: FE FE and 00 FA.
_COORDS = [-25.8, 25.0, -0.1, -2.58, 2.5, 0.1]
_280 = Robot(
    "MyCobot280",
    "mycobot280",
    lacking=_OLD,
    calls=[
        Call("is_in_position", (_LOWEST,), "is_in_position", (_LOWEST, 0)),
        Call("set_color", (), "set_color", (0, 0, 0)),
        _home(),
        Call("gripper_stop", (), "set_gripper_value", (0, 0, 1, 1)),
        Call("is_torque_gripper", (), "get_servo_data", (7, 1)),
        *_synchronous(_LOWEST, _COORDS),
        *_synchronous(_LOWEST, _COORDS, 1)[1:],
    ],
)
_280_RDKX5 = Robot(
    "MyCobot280RDKX5",
    "mycobot280_rdkx5",
    methods={
        "check_async_or_sync": "async_or_sync",
        "drag_clear_record_data": "clear_drag_record_data",
        "drag_end_record": "end_drag_record",
        "drag_get_record_data": "get_drag_record_data",
        "drag_get_record_len": "get_drag_record_len",
        "drag_start_record": "start_drag_record",
        "is_controller_connected": "is_tool_connected",
        "set_color": "set_tool_color",
    },
    lacking=_OLD | dict.fromkeys(("jog_increment", "get_radians", "send_radians"), _OTHER_NAME),
    calls=_synchronous(_ZERO, _ZERO, 1),
)
# The maker's older class, with its requests of the edition mycobot.
_OLDEST = Robot(
    "MyCobot",
    "mycobot",
    calls=[
        _home(),
        _same("send_angle", 1, 0, 0),
        _same("send_angles", _ZERO, 0),
        *_synchronous(_ZERO, _ZERO, 1),
    ],
)
_PINCH = "set_hand_gripper_pinch_action"
_320 = Robot(
    "MyCobot320",
    "mycobot320",
    lacking=_OLD,
    calls=[
        _home(),
        *_synchronous(_ZERO, _ZERO, 1),
        _same(_PINCH, 1, 0),
        _same(_PINCH, 1, 5, False),
    ],
    own_arguments={_PINCH: [(0, 5, 1, 1), (4, 1, 1, 14), (4, 20, 1, 254)]},
)
_MECHARM = Robot(
    "MechArm270",
    "mecharm270",
    lacking=_OLD,
    calls=[
        _home(),
        Call("is_torque_gripper", (), "get_servo_data", (7, 1)),
        *_synchronous(_ZERO, _ZERO, 1),
    ],
)
_LOWEST_260 = [-162, -2, -92, -180]
_PALLETIZER = Robot(
    "MyPalletizer260",
    "mypalletizer260",
    calls=[
        Call("is_in_position", (_LOWEST_260,), "is_in_position", (_LOWEST_260, 0)),
        Call("set_color", (), "set_color", (0, 0, 0)),
        Call("sync_send_angles", ([162, 90, 60, 180], 50), "send_angles", ([162, 90, 60, 180], 50)),
        Call("sync_send_coords", ([200, 0, 100, 9], 50), "send_coords", ([200, 0, 100, 9], 50)),
        _home(4),
    ],
)
_HIGHEST_300 = [160, 115, 170, 75, 170, 115, 180]
_END = [200, -25.8, 100, 9, -2.58, 180]
_300 = Robot(
    "MyArm",
    "myarm300",
    calls=[
        Call("is_in_position", (_HIGHEST_300, 0), "is_in_position", (_HIGHEST_300,)),
        Call("is_in_position", (_END, 1), "is_in_position_coords", (_END,)),
        _home(7),
        *_synchronous(_HIGHEST_300, _END),
    ],
    lacking={"is_in_position_coords": "the maker has is_in_position with id 1 for it"},
)
_METHODS = {
    "get_system_version": "get_robot_firmware_version",
    "get_angles": "get_joints_angle",
    "get_coords": "get_joints_coord",
    "set_servo_calibration": "set_servo_calibrate",
    "set_color": "set_tool_led_color",
}
_PAGES = "only the maker's pages have it"
_C650 = Robot(
    "MyArmC",
    "myarm_c650",
    methods=_METHODS,
    lacking=dict.fromkeys(
        [
            *("set_pin_mode", "power_on", "power_off", "is_power_on", "set_servo_enabled"),
            *("clear_robot_err", "get_joints_min", "get_joints_max"),
        ],
        _PAGES,
    ),
)
_ENCODERS = [2000, 1598, 2498, 2000, 2000, 2000, 2000, 2000]
_M750 = Robot(
    "MyArmM",
    "myarm_m750",
    methods=_METHODS
    | {
        "power_on": "set_robot_power_on",
        "power_off": "set_robot_power_off",
        "is_power_on": "get_robot_power_status",
        "send_angle": "set_joint_angle",
        "send_angles": "set_joints_angle",
        "stop": "stop_robot",
        "is_moving": "is_robot_moving",
    },
    lacking={"set_pin_mode": _PAGES},
    calls=[
        _same("set_servos_encoder", _ENCODERS, 50),
        _same("set_servos_encoder_drag", _ENCODERS, [500] * 8),
    ],
)
ROBOTS = (_280, _280_RDKX5, _OLDEST, _320, _MECHARM, _PALLETIZER, _300, _C650, _M750)
