"""The myCobot 280 with an M5Stack."""

from __future__ import annotations

from robots.robot import Call, Robot

_LOWEST = [-168, -140, -150, -150, -155, -180]
# Header and footer inside the data: FE FE and 00 FA.
_COORDS = [-25.8, 25.0, -0.1, -2.58, 2.5, 0.1]
ROBOT = Robot(
    "MyCobot280",
    "mycobot280",
    lacking={"jog_stop": "a command of the document's edition, which the 280 keeps"},
    calls=[
        Call("is_in_position", (_LOWEST,), "is_in_position", (_LOWEST, 0)),
        Call("set_color", (), "set_color", (0, 0, 0)),
        Call("go_home", (), "send_angles", ([0] * 6, 10)),
        Call("gripper_stop", (), "set_gripper_value", (0, 0, 1, 1)),
        Call("is_torque_gripper", (), "get_servo_data", (7, 1)),
        Call("sync_send_angles", (_LOWEST, 50), "send_angles", (_LOWEST, 50)),
        Call("sync_send_coords", (_COORDS, 50), "send_coords", (_COORDS, 50, 0)),
        Call("sync_send_coords", (_COORDS, 50, 1), "send_coords", (_COORDS, 50, 1)),
    ],
)
