"""Compare the requests of pymycobot's classes for arms with other numbers of joints with ours."""

from __future__ import annotations

import math
from typing import NamedTuple

from cobotwire.client import Client
from cobotwire.codec import CodecName
from cobotwire.editions import load
from cobotwire.protocol.table import Table
from pymycobot_280_requests import Arguments, as_called, corners
from pymycobot_classes import CLASSES, REJECTIONS, recording_client, without_port, written


class RowArm(NamedTuple):
    """An edition, pymycobot's class for it, and what the comparison needs to know.

    Attributes:
        edition: our edition.
        peer: the name of pymycobot's class.
        by_hand: arguments instead of the corners of the table, where pymycobot rejects these.
        composed: a call of pymycobot that another method of ours sends: method, arguments, ours.
        ruled: methods, and arguments that the two sides encode differently or one rejects: why.
        local: public names of the class that send no frame.
        rejected: calls of pymycobot that send a frame which no arm of the edition reads: why.
    """

    edition: str
    peer: str
    by_hand: dict[str, list[Arguments]]
    composed: list[tuple[str, Arguments, str, Arguments]]
    ruled: dict[str, tuple[Arguments, str]]
    local: frozenset[str]
    rejected: dict[str, tuple[Arguments, str]]

    @property
    def table(self) -> Table:
        """The table of the edition."""
        return load(self.edition).TABLE

    def client(self, codec: CodecName) -> Client:
        """Return a client of the edition on a transport that only records."""
        return recording_client(codec, load(self.edition).CLIENT)

    def theirs(self, method: str, arguments: Arguments) -> bytes | None:
        """Return the bytes that pymycobot writes; None if it rejects the arguments."""
        try:
            return written(without_port(self.peer), method, arguments)
        except (*REJECTIONS, *_raised(self.peer)):
            return None

    def requests(self) -> dict[str, list[Arguments]]:
        """Return the arguments for each command of the edition."""
        return {
            command.name: self.by_hand.get(command.name)
            or [
                as_called(command.name, variant, values)
                for variant in command.request
                for values in corners(variant)
            ]
            for command in self.table.commands
        }

    def methods(self) -> set[str]:
        """Return the public methods of pymycobot's class that send a frame."""
        public = {name for name in dir(CLASSES[self.peer]) if not name.startswith("_")}
        return public - self.local


def _raised(peer: str) -> tuple[type[Exception], ...]:
    from pymycobot import error

    return tuple(kind for name, kind in vars(error).items() if name.endswith("DataException"))


_LOCAL = frozenset(
    {"check_python_version", "close", "crc_check", "crc_robot_class", "open", "wait"}
)
_LOCAL |= {"gpio_init", "gpio_output"}
_LIMITS = "0x21 0x22 0x24 0x25 0x31: the limits that pymycobot lists; its class does not apply them"
_JOINT = "joints are 1..4, as pymycobot lists them; its class checks 0..5, or nothing"
_SPEED = "0x41: a speed is 1..100, as pymycobot lists it; its class accepts 0"
_PORT = "0xB2: a port is 1..65535; pymycobot packs any signed word"
_TENTH = "0x4C 0x4D: any tenth of a degree here; pymycobot takes whole degrees only"
_REGISTER = "0x52: registers 0 to 4 cannot be written, as on the 280; pymycobot does not check"
_NEAREST = "encode: the nearest step (0.29 x100 is 29); pymycobot cuts off the rest (28)"
_FREE = "0x1A: free mode is on or off; pymycobot also sends 254"
_RADIANS = "0x22: the nearest hundredth of a degree; pymycobot cuts off the rest"
_COUNT = "0x3C: as many encoders as joints, and a speed of 1..100; pymycobot checks neither"

_ZERO = [0, 0, 0, 0]
_EXTREMES = [[-162, -2, -92, -180], [162, 90, 60, 180]]
PALLETIZER_260 = RowArm(
    "mypalletizer260",
    "MyPalletizer260",
    by_hand={
        "send_radians": [([0, math.pi / 4, -math.pi / 2, math.pi], 20), (_ZERO, 1)],
        "is_in_position": [(row, 0) for row in _EXTREMES]
        + [([-260, -260, -15, -180], 1), ([260, 260, 357.5, 180], 1)],
        "set_server_port": [(1,), (9000,), (32767,)],
        "set_ssid_pwd": [("home", "secret words")],
    },
    composed=[
        ("is_in_position", (_EXTREMES[0],), "is_in_position", (_EXTREMES[0], 0)),
        ("set_color", (), "set_color", (0, 0, 0)),
        ("sync_send_angles", (_EXTREMES[1], 50), "send_angles", (_EXTREMES[1], 50)),
        ("sync_send_coords", ([200, 0, 100, 9], 50), "send_coords", ([200, 0, 100, 9], 50)),
    ],
    ruled={
        "set_server_port": ((40000,), _PORT),
        "set_joint_min": ((1, -90.5), _TENTH),
        "set_joint_max": ((1, 90.5), _TENTH),
        "set_servo_data": ((1, 4, 1), _REGISTER),
        "send_angle": ((1, 0.29, 50), _NEAREST),
        "send_angles": (([0, 91, 0, 0], 50), _LIMITS),
        "send_coord": ((1, 261, 50), _LIMITS),
        "send_coords": (([0, 0, -16, 0], 50), _LIMITS),
        "jog_absolute": ((1, 163, 50), _LIMITS),
        "jog_angle": ((0, 1, 50), _JOINT),
        "jog_increment": ((5, 1, 50), _JOINT),
        "set_speed": ((0,), _SPEED),
        "set_encoder": ((5, 2048, 50), _JOINT),
        "set_free_mode": ((254,), _FREE),
        "send_radians": (([1, 0.5, 0, 0], 50), _RADIANS),
        "set_encoders": (([1, 2, 3], 0), _COUNT),
    },
    local=_LOCAL,
    rejected={"go_home": ((), "0x22: the arm has four joints; pymycobot sends three angles")},
)
ROW_ARMS = [PALLETIZER_260]
