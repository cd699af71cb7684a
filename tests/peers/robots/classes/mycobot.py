"""The maker's older class for the myCobot: here, its requests of the document's edition."""

from __future__ import annotations

from robots.robot import Call, Robot

_ZERO = [0] * 6
ROBOT = Robot(
    "MyCobot",
    "mycobot",
    calls=[
        Call("go_home", (), "send_angles", (_ZERO, 10)),
        Call("send_angle", (1, 0, 0), "send_angle", (1, 0, 0)),
        Call("send_angles", (_ZERO, 0), "send_angles", (_ZERO, 0)),
        Call("sync_send_angles", (_ZERO, 50), "send_angles", (_ZERO, 50)),
        Call("sync_send_coords", (_ZERO, 50, 1), "send_coords", (_ZERO, 50, 1)),
    ],
)
