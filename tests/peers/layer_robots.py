"""The classes that the layer is compared with: the classes of ``robots``, and other classes of the
same robots."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from pymycobot_classes import library
from robots.classes import ROBOTS
from robots.opening import on_socket, opened_by_client
from robots.robot import Robot


def _another(peer: str, of: str, **changes: Any) -> Robot:
    """Return the description of another class of a robot."""
    given = ROBOTS[of]
    calls = [each for each in given.calls if hasattr(library(peer), each.method)]
    return replace(given, peer=peer, further=(), calls=calls, **changes)


# Further classes of the library for robots that already have a class. The older ones are compared
# on the editions that the layer has for them.
SAME_ROBOT: dict[str, Robot] = {
    "MechArm": _another("MechArm", "MechArm270"),
    "MyBuddySocket": _another("MyBuddySocket", "MyBuddy", opened=on_socket),
    "MyCobot": _another("MyCobot", "MyCobot280"),
    "MyCobotSocket": _another("MyCobotSocket", "MyCobot280", opened=on_socket),
    "MechArmSocket": _another("MechArmSocket", "MechArm270", opened=on_socket),
    "MyArmSocket": _another("MyArmSocket", "MyArm", opened=on_socket),
    "MyCobot280RDKX5Socket": _another("MyCobot280RDKX5Socket", "MyCobot280RDKX5", opened=on_socket),
    "MyCobot280Socket": _another("MyCobot280Socket", "MyCobot280", opened=on_socket),
    "MyCobot320Socket": _another("MyCobot320Socket", "MyCobot320", opened=on_socket),
    "MyPalletizerSocket": _another("MyPalletizerSocket", "MyPalletizer260", opened=on_socket),
}
# Robots that report the end of motions, and the classes that reach them by TCP.
CLOSED_LOOP: dict[str, Robot] = {
    **{
        name: ROBOTS[name]
        for name in ("Mercury (A1)", "Mercury (B1, X1)", "Pro400", "Pro630", "Pro450Client")
    },
    "MercurySocket": _another("MercurySocket", "Mercury (B1, X1)", opened=opened_by_client),
    "Pro400Client": _another("Pro400Client", "Pro400", opened=opened_by_client),
    "Pro630Client": _another("Pro630Client", "Pro630", opened=opened_by_client),
}
LAYER_ROBOTS: dict[str, Robot] = {**ROBOTS, **SAME_ROBOT}
ALL_ROBOTS = {**LAYER_ROBOTS, **CLOSED_LOOP}
# The classes that open a TCP connection.
SOCKETS = [name for name in ALL_ROBOTS if name.endswith(("Socket", "Client"))]
# Classes of robots that also have a serial class. One of them is compared, as an example of all.
TCP_TWINS = {name for name in SOCKETS if name not in ROBOTS} - {"MyCobot280Socket"}
# This class cannot be compared: each call of the maker's class fails.
PALLETIZER = _another("MyPalletizer", "MyPalletizer260")
