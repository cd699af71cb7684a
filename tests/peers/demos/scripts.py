"""The demos that need no camera, gamepad, window or pins of a Raspberry Pi."""

from __future__ import annotations

from typing import NamedTuple

REPOSITORY = "https://github.com/elephantrobotics/pymycobot"
# The state of the demos that the table is about.
COMMIT = "44d7fb1"


class Demo(NamedTuple):
    """A program of the maker.

    Attributes:
        path: its file in the repository.
        edition: our edition of the robot that it drives.
        typed: what a person types.
        arguments: its command line.
    """

    path: str
    edition: str = "mycobot280"
    typed: str = ""
    arguments: tuple[str, ...] = ()


# What port_setup asks: the number of the port, the speed, debugging.
_CHOSEN = "1\n\nn\n"
DEMOS = [
    Demo("demo/Client.py"),
    Demo("demo/basic.py", typed=_CHOSEN),
    Demo("demo/gripper.py", typed=_CHOSEN),
    Demo("demo/gripper_set.py"),
    Demo("demo/loop.py", typed=_CHOSEN),
    Demo("demo/pid_read_write.py"),
    Demo("demo/myCobot_280_demo/280_draw_gcode.py", typed="1\n4\n"),
    Demo("demo/tools/pump_demo_M5.py"),
]
