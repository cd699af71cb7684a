"""Let one of the maker's classes, unmodified, drive our simulated robot.

Time is stepped: the class waits and sleeps by the clock of the robot, so a request without a reply
costs no real time.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import Any

import pytest

from cobotwire.conformance.device.read_back import has_fixed_effect, settings_of
from cobotwire.protocol.table import Command, Variant
from cobotwire.simulator import SimulatedArm
from pymycobot_classes import library
from robots.arguments import TEXTS, as_called, between
from robots.robot import Arguments, Robot

# How long a read of the port waits for a byte, in seconds.
READ_TIMEOUT = 0.05
# How long motions may last, in seconds.
LONGEST_MOTION = 60.0
# A joint stops on an encoder tick: off by up to half a tick, then truncated to hundredths. Radians
# are rounded to thousandths.
READ_BACK = 0.054
# The end is where the joints stop, in millimetres.
READ_BACK_END = 0.8


class SteppedTime:
    """Stand in for the module ``time`` in the modules of the maker's library."""

    def __init__(self) -> None:
        self.now = 1000.0

    def time(self) -> float:
        return self.now

    monotonic = perf_counter = time

    def sleep(self, seconds: float) -> None:
        self.now += seconds

    def __getattr__(self, name: str) -> Any:
        return getattr(time, name)


class ArmPort:
    """The part of ``serial.Serial`` that the maker's classes use, on a robot in this process."""

    def __init__(self, arm: SimulatedArm, clock: SteppedTime) -> None:
        self._peer, self._clock, self._waiting = arm.connect(), clock, b""
        self.timeout = READ_TIMEOUT

    def isOpen(self) -> bool:
        return True

    is_open = True

    def reset_input_buffer(self) -> None:
        self._waiting = b""

    def write(self, data: Any) -> int:
        self._waiting += self._peer.receive(bytes(data))
        return len(data)

    def flush(self) -> None:
        """Do nothing: the robot has received everything."""

    def inWaiting(self) -> int:
        self._waiting += self._peer.flush()
        return len(self._waiting)

    in_waiting = property(inWaiting)

    def read(self, size: int = 1) -> bytes:
        if not self._waiting:
            self._clock.sleep(READ_TIMEOUT)
            self._waiting += self._peer.flush()
        data, self._waiting = self._waiting[:size], self._waiting[size:]
        return data

    def close(self) -> None:
        """Do nothing: there is nothing to release."""


class Drive:
    """An object of the maker's class, the robot that it drives, and their clock."""

    def __init__(self, robot: Robot, clock: SteppedTime) -> None:
        self.robot, self.clock = robot, clock
        self.arm = SimulatedArm(robot.table, clock=clock.time, powered=True)
        self.peer = robot.on(ArmPort(self.arm, clock))

    def call(self, command: Command, arguments: Arguments, address: str | None) -> Any:
        """Call the method of the class for a command."""
        before = self.robot.before[address]
        if command.name in self.robot.without_address:
            before = ()
        return getattr(self.peer, self.robot.method(command))(*before, *arguments)

    def settle(self) -> None:
        """Let every motion end."""
        self.clock.sleep(LONGEST_MOTION)


@contextmanager
def stepped() -> Iterator[SteppedTime]:
    """Step the time of the maker's library, and of our layer."""
    clock, modules = SteppedTime(), _timed(len(sys.modules))
    for module in modules:
        module.time = clock
    try:
        yield clock
    finally:
        for module in modules:
            module.time = time


@lru_cache(maxsize=1)
def _timed(loaded: int) -> list[Any]:
    """Return the modules of the library and of our layer that use the time."""
    names = ("pymycobot", "cobotwire.pymycobot")
    found = [module for name, module in sys.modules.items() if name.startswith(names)]
    return [each for each in found if isinstance(getattr(each, "time", None), type(time))]


@contextmanager
def driven(robot: Robot) -> Iterator[Drive]:
    """Drive a simulated robot with the maker's class, in stepped time."""
    with stepped() as clock:
        yield Drive(robot, clock)


def wrong_replies(robot: Robot) -> tuple[int, list[str]]:
    """Call each method that has a reply once for each address; return how many, and what is wrong.

    A value must have the type of the reply: a list for several numbers, else a number.
    """
    called, wrong = 0, []
    for command, method in _methods(robot):
        if not (command.reply or command.text) or method in robot.unanswered:
            continue
        for address in robot.addresses(command):
            # One method may have switched off or moved what the next one needs.
            with driven(robot) as drive:
                result = _result(drive, command, address)
            called += 1
            if not _fits(command, result, robot.kinds.get(method)):
                wrong.append(f"{method} at {address} returned {result!r}")
    return called, wrong


def _result(drive: Drive, command: Command, address: str | None) -> Any:
    """Return the result of a call with arguments that the class accepts."""
    rejected: Exception | None = None
    for variant in reversed(command.request):
        try:
            return drive.call(command, _arguments(drive.robot, command, variant, address), address)
        except Exception as error:  # any: the maker's classes fail in many ways
            rejected = error
    return rejected


def _fits(command: Command, result: Any, kind: type | None) -> bool:
    if isinstance(result, bool) or result is None or result == -1:
        return False
    if kind is not None:
        return isinstance(result, kind)
    if command.text is not None:
        return isinstance(result, tuple)
    if command.ack:
        return result in (1, [1])
    return any(
        isinstance(result, list if _several(variant) else int | float) for variant in command.reply
    )


def _several(variant: Variant) -> bool:
    values = [field for field in variant.fields if not field.echo and field.const is None]
    return len(values) > 1 or any(field.many for field in values)


def wrong_read_backs(robot: Robot) -> tuple[int, list[str]]:
    """Set each value that a query reads back; return how many were read, and what is wrong."""
    checked, wrong = 0, []
    for command, method in _methods(robot):
        back = command.read_by
        if back is None or method in robot.not_read_back:
            continue
        query = robot.table.command(back.query)
        if robot.method(query) in robot.unanswered or not hasattr(
            library(robot.peer), robot.method(query)
        ):
            continue
        for address in robot.addresses(command):
            checked += 1
            text = _read_back(robot, command, query, address)
            wrong += [f"{method} at {address}: {text}"] if text else []
    return checked, wrong


def _read_back(robot: Robot, command: Command, query: Command, address: str | None) -> str:
    setting = next(iter(settings_of(robot.table, command)), None)
    variant = setting.variant if setting else command.request[0]
    with driven(robot) as drive:
        arguments = _arguments(robot, command, variant, address)
        drive.call(command, arguments, address)
        drive.settle()
        given = dict(zip(command.argument_names, arguments, strict=False))
        query_variant = setting.query_variant if setting else query.request[0]
        fields = {field.name for field in query_variant.fields}
        names = [name for name in query.argument_names if name in fields]
        shared = tuple(given[name] for name in names if name in given)
        result = drive.call(query, shared, address)
    if has_fixed_effect(command):
        assert command.read_by is not None
        wanted: Any = command.read_by.fields[0][1]
    elif setting is None:
        return "no setting"
    else:
        wanted = [given[name] for _, name in setting.pairs]
        wanted = wanted[0] if len(wanted) == 1 else wanted
    near = READ_BACK_END if query.role == "coordinates" else READ_BACK
    return "" if _alike(wanted, result, near) else f"set {wanted}, read {result}"


def _alike(wanted: Any, result: Any, near: float) -> bool:
    if isinstance(result, list | tuple) and not isinstance(wanted, list):
        wanted = [wanted]
    if isinstance(wanted, list) and all(isinstance(each, str) for each in wanted):
        return list(result) == wanted
    return bool(result == pytest.approx(wanted, abs=near))


def _methods(robot: Robot) -> Iterator[tuple[Command, str]]:
    """Return our commands that the class has a method for."""
    for command in robot.table.commands:
        method = robot.method(command)
        if not command.event and hasattr(library(robot.peer), method):
            yield command, method


def _arguments(robot: Robot, command: Command, variant: Variant, address: str | None) -> Arguments:
    if command.name in robot.driven:
        return robot.driven[command.name]
    if command.request_text is not None:
        # The maker's classes report the last word of an account only.
        return tuple(text.split()[0] for text in TEXTS[: len(command.request_text.fields)])
    device, values = robot.device(address), between(variant)
    if device is not None and device.joints and variant.fields[:1]:
        first, *others = values
        values = (
            min(first, device.joints) if variant.fields[0].name == "joint" else first,
            *others,
        )
    return as_called(command, variant, values)
