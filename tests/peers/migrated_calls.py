"""Run each method of each class of the library before and after ``cobotwire migrate``."""

from __future__ import annotations

import inspect
import time
from collections.abc import Iterator
from typing import Any, NamedTuple

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
# Classes that the comparison with the library leaves out, with the class that has the same methods.
SAME_METHODS = {
    "MyCobot280Socket": "MyCobot280",
    "MyCobot280RDKX5Socket": "MyCobot280RDKX5",
    "MechArmSocket": "MechArm270",
    "MyCobot320Socket": "MyCobot320",
    "MyArmSocket": "MyArm",
}
# Names that are not calls of an arm.
NO_CALLS = {"open", "wait"}
# These are always compared.
STOPPING = {"pause", "resume", "stop"}
MARK = "# calls\n"
REJECTED, FAILED, MISTAKE, ABSENT = "rejected", "failed", "fails by mistake", "no such name"


class Done(NamedTuple):
    """The bytes that a line of a program wrote, the value that it kept, and the value's types."""

    written: bytes
    kept: Any
    kinds: Any


def lines_of(name: str, robot: Robot, stride: int) -> Iterator[str]:
    """Return calls of methods: with all arguments, by keyword, and with only the required ones."""
    given: dict[str, tuple[Any, ...]] = {}
    for call in calls_of(robot):
        given.setdefault(call.method, call.theirs)
    for each in {"send_angles", "send_coords"} & given.keys():
        given[f"sync_{each}"] = given[each]
    first = sorted(library()).index(name)
    for index, method in enumerate(sorted(methods_of(name)), start=first):
        if index % stride and method not in STOPPING:
            continue
        [_, *taken] = inspect.signature(getattr(library()[name].layer, method)).parameters.values()
        needed = [p for p in taken if p.default is p.empty and p.kind is p.POSITIONAL_OR_KEYWORD]
        values = given.get(method, (0,) * len(needed))
        named = ", ".join(f"{p.name}={value!r}" for p, value in zip(taken, values))
        few, every = (", ".join(map(repr, each)) for each in (values[: len(needed)], values))
        yield f"keep(arm.{method}({few}))"
        yield from (f"arm.{method}({each})" for each in dict.fromkeys([few, every, named]))


def methods_of(name: str) -> set[str]:
    """Return the methods of a class, except those that it shares with another class."""
    kind = library()[name]
    found = set(filter(kind.is_method, dir(kind.layer))) - NO_CALLS
    bases = {base.__name__ for base in kind.layer.__mro__[1:]}
    like = next((library()[each] for each in library() if each in bases), None)
    if like is None or like.client is not kind.client:
        return found
    return {each for each in found if not _is_same(kind, like, each)} | STOPPING & found


def _is_same(kind: LibraryClass, other: LibraryClass, name: str) -> bool:
    same = getattr(kind.layer, name) is getattr(other.layer, name, None)
    return same and kind.call(name) == other.call(name)


def done(arm: Any, transport: Recorded, line: str) -> Done:
    """Run a line of a program with an arm; if it fails, a constant replaces the value it keeps."""
    kept: list[Any] = []
    transport.written = b""
    try:
        exec(line, {"arm": arm, "keep": kept.append, "time": time})
    except (UsageError, NotImplementedError):
        kept = [REJECTED]
    except TypeError:
        kept = [MISTAKE]
    except AttributeError:
        kept = [ABSENT]
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


def compare_migrated(name: str, stride: int = 1) -> tuple[int, int, list[str]]:
    """Compare calls of every ``stride``-th method of a class with the rewritten calls.

    Return how many are equal, how many ``migrate`` lists, and the others in words.
    """
    robot, client = ROBOTS[SAME_METHODS.get(name, name)], library()[name].client
    lines = list(lines_of(name, robot, stride))
    head = f"from pymycobot import {name}\narm = {name}(port)\n{MARK}"
    found = migrate(head + "\n".join(lines) + "\n")
    after = found.text.partition(MARK)[2].splitlines()
    listed = {each.line - head.count("\n") for each in found.decisions}
    wrong = []
    for at, (before, line) in enumerate(zip(lines, after, strict=True), start=1):
        if at in listed:
            continue
        here, there = simulated(robot), simulated(robot)
        theirs = done(layer_on(name, here, client), here, before)
        ours = done(client(there), there, line)
        if theirs != ours and theirs.kept != [MISTAKE]:
            wrong.append(f"{before}: {theirs}; {line}: {ours}")
    return len(lines) - len(listed), len(listed), wrong
