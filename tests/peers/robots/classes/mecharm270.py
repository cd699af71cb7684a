"""The mechArm 270."""

from __future__ import annotations

from robots.robot import Call, Robot

_ZERO = [0] * 6
ROBOT = Robot(
    "MechArm270",
    "mecharm270",
    lacking={"jog_stop": "a command of the document's edition, which the 280 keeps"},
    calls=[
        Call("go_home", (), "send_angles", (_ZERO, 10)),
        Call("is_torque_gripper", (), "get_servo_data", (7, 1)),
        Call("sync_send_angles", (_ZERO, 50), "send_angles", (_ZERO, 50)),
        Call("sync_send_coords", (_ZERO, 50, 1), "send_coords", (_ZERO, 50, 1)),
    ],
)
