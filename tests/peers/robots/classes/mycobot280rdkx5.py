"""The myCobot 280 on an RDK X5."""

from __future__ import annotations

from robots.robot import Call, Robot

_ZERO = [0] * 6
_OTHER_NAME = "the older class for the 280 has the method"
ROBOT = Robot(
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
    lacking={
        "jog_stop": "a command of the document's edition, which the 280 keeps",
        "jog_increment": _OTHER_NAME,
        "get_radians": _OTHER_NAME,
        "send_radians": _OTHER_NAME,
    },
    calls=[
        Call("sync_send_angles", (_ZERO, 50), "send_angles", (_ZERO, 50)),
        Call("sync_send_coords", (_ZERO, 50, 1), "send_coords", (_ZERO, 50, 1)),
    ],
)
