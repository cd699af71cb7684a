"""States facts of the transport, and defaults of arguments, as the maker's library has them."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from functools import lru_cache

from cobotwire_codegen.model import Edition
from pymycobot_classes import library
from robots.classes import ROBOTS

MAKER = library("MyCobot280")
# The document's edition has the defaults of the class for newer firmware.
CLASSES = {robot.edition: robot for robot in ROBOTS.values()} | {"mycobot": ROBOTS["MyCobot280"]}
CLASSES["mercury_x1"] = CLASSES["mercury_b1"]
# For these the library waits longer: `read` in its common.py, `_read` in its myarm_api.py.
WAITS_MS = {
    "mercury": {"power_on": 8000},
    "pro": {"power_on": 8000},
    "myarm_": {"get_robot_error_status": 90000},
    "mycobot320": {"get_robot_status": 75000},
}
# Arguments that the edition must be given, or gives, unlike the library; each has its ruling there.
RULED_DEFAULTS = (
    r"(mercury|pro)\S+ (pause|resume|stop) deceleration|(mercury|pro)\S+ write_move_c_r arc"
    r"|(mercury|pro)\S+ [sg]et_pro_gripper address|mycobot280_rdkx5 get_gripper_value gripper"
    r"|(myarm300|mybuddy) set_color \w+|mybuddy is_in_position kind|pro630 power_on mode"
    r"|mycobot320 set_hand_gripper_pinch_action \w+"
    r"|pro450 set_(control_mode mode|torque_comp damping|tool_serial_timeout timeout)"
    r"|(mercury|pro)\S+ \wet_(hand|pro)_gripper\w* (gripper|speed)"
)
# The servo bus runs at 1 Mbaud (Feetech, "Servo SCS Communication Protocol").
BUS_BAUDRATE = 1000000


def _baudrate(edition: str) -> int | None:
    """Return the rate at which the library opens a port unless it is told another."""
    if edition not in CLASSES:
        return BUS_BAUDRATE
    taken = inspect.signature(library(CLASSES[edition].peer).__init__).parameters
    return int(taken["baudrate"].default) if "baudrate" in taken else None


@lru_cache(maxsize=1)
def _wait_ms() -> int:
    """Return how long the library waits for the reply to a request, unless it knows better."""
    found = re.search(r"\belse:\s+wait_time = ([\d.]+)", inspect.getsource(MAKER._read))
    assert found, "the library states its default wait"
    return round(float(found[1]) * 1000)


def transport(edition: Edition) -> Iterator[str]:
    """Report another baud rate or deadline than the library uses."""
    if edition.frame.baudrate != (_baudrate(edition.name) or edition.frame.baudrate):
        yield f"{edition.frame.baudrate} baud; the maker's library has {_baudrate(edition.name)}"
    if edition.name in CLASSES:
        found = (w for prefix, w in WAITS_MS.items() if edition.name.startswith(prefix))
        waits = next(found, {})
        for command in edition.commands:
            wanted = waits.get(command.name, _wait_ms())
            if command.deadline_ms != wanted:
                yield f"{command.name}: {command.deadline_ms} ms; the maker's library {wanted} ms"


def defaults(edition: Edition) -> Iterator[str]:
    """Report arguments with another default than those of the library's method, or without one.

    A command of the library's name has its arguments in the library's order.
    """
    robot = CLASSES.get(edition.name)
    if robot is None:
        return
    for command in edition.commands:
        theirs = _defaults(robot.peer, robot.methods.get(command.name, command.name))
        fields = [f for variant in command.requests[:1] for f in variant if f.const is None]
        if command.arguments:
            fields.sort(key=lambda field: command.arguments.index(field.name))
        for field, default in zip(fields, theirs):
            ours = None if field.default is None else field.default[0]
            named = f"{edition.name} {command.name} {field.name}"
            if ours != default and not re.fullmatch(RULED_DEFAULTS, named):
                yield f"{command.name}: {field.name} has the default {ours}; the library {default}"


@lru_cache(maxsize=4096)
def _defaults(peer: str, name: str) -> tuple[int | None, ...]:
    """Return the defaults of a method of the library; None where an argument has none."""
    method = getattr(library(peer), name, None)
    given = [] if method is None else list(inspect.signature(method).parameters.values())[1:]
    return tuple(None if p.default in (p.empty, None) else int(p.default) for p in given)


RULES = (transport, defaults)
