"""The myCobot 320."""

from __future__ import annotations

from robots.robot import Call, Robot

_ZERO = [0] * 6
_PINCH = "set_hand_gripper_pinch_action"
ROBOT = Robot(
    "MyCobot320",
    "mycobot320",
    lacking={"jog_stop": "a command of the document's edition, which the 280 keeps"},
    calls=[
        Call("go_home", (), "send_angles", (_ZERO, 10)),
        Call("sync_send_angles", (_ZERO, 50), "send_angles", (_ZERO, 50)),
        Call("sync_send_coords", (_ZERO, 50, 1), "send_coords", (_ZERO, 50, 1)),
        Call(_PINCH, (1, 0), _PINCH, (1, 0)),
        Call(_PINCH, (1, 5, False), _PINCH, (1, 5, False)),
    ],
    own_arguments={_PINCH: [(0, 5, 1, 1), (4, 1, 1, 14), (4, 20, 1, 254)]},
)
