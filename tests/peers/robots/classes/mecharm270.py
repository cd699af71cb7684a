"""The mechArm 270."""

from __future__ import annotations

from robots.robot import GPIO, LOCAL, Call, Robot, Ruling

_ZERO = [0] * 6
_KIND = Ruling(
    "NoneType", "the kind may be left out; the maker's check of a missing kind fails by mistake"
)
ROBOT = Robot(
    "MechArm270",
    "mecharm270",
    local=LOCAL | GPIO,
    lacking={"jog_stop": "a command of the document's edition, which the 280 keeps"},
    calls=[
        Call("go_home", (), "send_angles", (_ZERO, 10)),
        Call("is_torque_gripper", (), "get_servo_data", (7, 1)),
        Call("sync_send_angles", (_ZERO, 50), "send_angles", (_ZERO, 50)),
        Call("sync_send_coords", (_ZERO, 50, 1), "send_coords", (_ZERO, 50, 1)),
    ],
    rulings={
        "set_gripper_state": [_KIND],
        "set_gripper_value": [_KIND],
    },
)
