"""The myArm 300."""

from __future__ import annotations

from robots.robot import Call, Robot

_ZERO = [0] * 7
_LOWEST, _HIGHEST = [-160, -70, -170, -113, -170, -115, -180], [160, 115, 170, 75, 170, 115, 180]
_END = [200, -25.8, 100, 9, -2.58, 180]
ROBOT = Robot(
    "MyArm",
    "myarm300",
    calls=[
        Call("is_in_position", (_HIGHEST, 0), "is_in_position", (_HIGHEST,)),
        Call("is_in_position", (_END, 1), "is_in_position_coords", (_END,)),
        Call("go_home", (), "send_angles", (_ZERO, 10)),
        Call("sync_send_angles", (_HIGHEST, 50), "send_angles", (_HIGHEST, 50)),
        Call("sync_send_coords", (_END, 50), "send_coords", (_END, 50, 0)),
    ],
    lacking={"is_in_position_coords": "the maker has is_in_position with id 1 for it"},
)
