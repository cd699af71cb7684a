"""The myCobot 280 with an M5Stack."""

from __future__ import annotations

from pymycobot_280_differences import DIFFERENCES
from pymycobot_280_requests import COMPOSED
from robots.robot import DRIVEN, GPIO, LOCAL, Call, Robot, Ruling
from robots.rulings import EMPTY, REACHED, SETTERS, SPAN, limits

ROBOT = Robot(
    "MyCobot280",
    "mycobot280",
    local=LOCAL | GPIO,
    lacking={"jog_stop": "a command of the document's edition, which the 280 keeps"},
    calls=[
        *(Call(theirs, given, ours, arguments) for theirs, given, ours, arguments in COMPOSED),
        *(
            Call(each.method, each.theirs, command, each.ours, why=each.ruling)
            for (command, _), each in DIFFERENCES.items()
        ),
    ],
    rulings={
        **SETTERS,
        "is_in_position": limits("Has invalid"),
        "set_tool_reference": limits("Has invalid coord"),
        "set_world_reference": limits("Has invalid coord"),
        "jog_increment_angle": [Ruling("increment angle value not right", SPAN)],
    },
    driven={**DRIVEN, "send_coords": REACHED},
    unanswered={"drag_get_record_data": EMPTY},
)
