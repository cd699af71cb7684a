"""The myPalletizer 260."""

from __future__ import annotations

from robots.robot import Call, Robot

_ZERO = [0, 0, 0, 0]
_LOWEST, _HIGHEST = [-162, -2, -92, -180], [162, 90, 60, 180]
ROBOT = Robot(
    "MyPalletizer260",
    "mypalletizer260",
    calls=[
        Call("is_in_position", (_LOWEST,), "is_in_position", (_LOWEST, 0)),
        Call("set_color", (), "set_color", (0, 0, 0)),
        Call("sync_send_angles", (_HIGHEST, 50), "send_angles", (_HIGHEST, 50)),
        Call("sync_send_coords", ([200, 0, 100, 9], 50), "send_coords", ([200, 0, 100, 9], 50)),
        Call("go_home", (), "send_angles", (_ZERO, 10)),
    ],
)
