"""Each method of each class of the library, before and after ``cobotwire migrate``.

A rewritten call sends the same bytes and gives the same result, or it is listed for a decision.
"""

from __future__ import annotations

import inspect
import time
from collections.abc import Iterator
from typing import Any, NamedTuple

import pytest

import cobotwire.pymycobot as layer
from cobotwire.protocol.errors import ArmNotReady, ProtocolError, UsageError
from cobotwire.pymycobot.migrate import migrate
from cobotwire.pymycobot.migrate.calls import LibraryClass, library
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from layer_comparison import Recorded, layer_on
from layer_robots import CLOSED_LOOP, LAYER_ROBOTS, PALLETIZER
from robots.comparison import calls_of
from robots.robot import Robot

ROBOTS = {robot.peer: robot for robot in [*LAYER_ROBOTS.values(), *CLOSED_LOOP.values()]}
ROBOTS |= {"MyPalletizer": PALLETIZER, "Mercury": LAYER_ROBOTS["Mercury (A1)"]}
# Classes that the comparison with the library leaves out, and those of the same methods.
SAME_METHODS = {
    "MyCobot280Socket": "MyCobot280",
    "MyCobot280RDKX5Socket": "MyCobot280RDKX5",
    "MechArmSocket": "MechArm270",
    "MyCobot320Socket": "MyCobot320",
    "MyArmSocket": "MyArm",
}
# Methods without a command of their own, and arguments for them.
OTHERS: dict[str, tuple[Any, ...]] = {
    **dict.fromkeys(["go_home", "gripper_stop", "is_torque_gripper", "power_on", "power_off"], ()),
    **dict.fromkeys(["gpio_init", "set_servos_calibration", "get_base_coords"], ()),
    "gpio_output": (1, 1),
}
MARK = "# calls\n"
REJECTED, FAILED, MISTAKE = "rejected", "failed", "fails by mistake"


class Done(NamedTuple):
    """What a line wrote, what it kept, and the types of that."""

    written: bytes
    kept: Any
    kinds: Any


def lines_of(name: str, robot: Robot) -> Iterator[str]:
    """Return calls of each method: with all arguments, by keyword, and with those needed only."""
    given = {**OTHERS}
    for call in calls_of(robot):
        given.setdefault(call.method, call.theirs)
    for each in {"send_angles", "send_coords"} & given.keys():
        given[f"sync_{each}"] = given[each]
    for method in sorted(methods_of(name)):
        [_, *taken] = inspect.signature(getattr(getattr(layer, name), method)).parameters.values()
        values = given.get(method, ())
        needed = [p for p in taken if p.default is p.empty and p.kind is p.POSITIONAL_OR_KEYWORD]
        if len(values) < len(needed):
            continue
        named = ", ".join(f"{p.name}={value!r}" for p, value in zip(taken, values))
        few, every = (", ".join(map(repr, each)) for each in (values[: len(needed)], values))
        yield f"keep(arm.{method}({few}))"
        yield from (f"arm.{method}({each})" for each in dict.fromkeys([few, every, named]))


def methods_of(name: str) -> set[str]:
    """Return the methods of a class, but for those that it shares with another class."""
    kind = library()[name]
    found = {each for each in {*kind.methods, *OTHERS} if hasattr(kind.layer, each)}
    like = next((each for each in library() if each in _bases(kind.layer)), "")
    if not like or library()[like].client is not kind.client:
        return found
    other = library()[like]
    shared = (
        each for each in found if getattr(other.layer, each, None) is getattr(kind.layer, each)
    )
    return found - {each for each in shared if other.call(each) == kind.call(each)} | {"stop"}


def _method(kind: LibraryClass, name: str) -> Any:
    return getattr(kind.layer, name, None)


def _bases(kind: type) -> list[str]:
    return [base.__name__ for base in kind.__mro__[1:]]


def done(arm: Any, transport: Recorded, line: str) -> Done:
    """Run a line with an arm; an error stands for what it keeps."""
    kept: list[Any] = []
    transport.written = b""
    try:
        exec(line, {"arm": arm, "keep": kept.append, "time": time})
    except (UsageError, NotImplementedError):
        kept = [REJECTED]
    except TypeError:
        kept = [MISTAKE]
    except (TimeoutError, ProtocolError, ArmNotReady):
        kept = [FAILED]
    return Done(transport.written, kept, kinds(kept))


def kinds(value: Any) -> Any:
    """Return the types of a value and of its parts."""
    return [kinds(each) for each in value] if isinstance(value, list) else type(value)


def simulated(robot: Robot) -> Recorded:
    """Return a transport to an arm of a robot that has power."""
    clock = SteppedClock(1000.0)
    return Recorded(SimulatedArm(robot.table, clock=clock, powered=True), clock)


@pytest.mark.parametrize("name", sorted(library()))
def test_rewritten_call_does_the_same_or_is_listed(name: str) -> None:
    robot, client = ROBOTS[SAME_METHODS.get(name, name)], library()[name].client
    lines = list(lines_of(name, robot))
    head = f"from pymycobot import {name}\narm = {name}(port)\n{MARK}"
    found = migrate(head + "\n".join(lines) + "\n")
    after = found.text.partition(MARK)[2].splitlines()
    listed = {each.line - head.count("\n") for each in found.decisions}
    wrong = []
    for at, (before, line) in enumerate(zip(lines, after, strict=True), start=1):
        transports = [simulated(robot) for _ in range(2)]
        if at in listed:
            continue
        theirs = done(layer_on(name, transports[0], client), transports[0], before)
        ours = done(client(transports[1]), transports[1], line)
        if theirs != ours and theirs.kept != [MISTAKE]:
            wrong.append(f"{before}: {theirs}; {line}: {ours}")
    assert wrong == []
    assert len(listed) < len(lines)
