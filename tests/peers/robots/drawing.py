"""Draw calls from our ranges, and from the numbers that the maker's library states."""

from __future__ import annotations

import inspect
from typing import Any

from hypothesis import strategies as st

from drawn_values import stated
from pymycobot_classes import library
from robots.arguments import Named, as_called
from robots.robot import Call, Robot
from strategies import legal_values


@st.composite
def drawn_call(draw: st.DrawFn, robot: Robot, *, stated_by_maker: bool = False) -> Call:
    """Draw a call with legal values of ours.

    With ``stated_by_maker``, one of them is replaced by a number that the maker's library states
    for its parameter, or by one between two of these.
    """
    command = draw(st.sampled_from(_commands(robot)))
    method = robot.method(command)
    address = draw(st.sampled_from(robot.addresses(command)))
    variant = draw(st.sampled_from(command.request))
    arguments = as_called(command, variant, draw(legal_values(variant)))
    before = () if command.name in robot.without_address else robot.before[address]
    if stated_by_maker and arguments:
        at = draw(st.integers(0, len(arguments) - 1))
        other = draw(_other(robot, method, len(before) + at, arguments[at]))
        changed = Named((*arguments[:at], other, *arguments[at + 1 :]))
        changed.names, arguments = arguments.names, changed
    return Call(method, (*before, *arguments), command.name, arguments, address)


def _commands(robot: Robot) -> list[Any]:
    """Return our commands that the class has a method for, with arguments that can be drawn."""
    return [
        command
        for command in robot.table.commands
        if not (command.event or command.request_text or command.name in robot.own_arguments)
        and hasattr(library(robot.peer), robot.method(command))
        and robot.method(command) not in robot.not_ours
        and any(field.const is None for variant in command.request for field in variant.fields)
    ]


def _other(robot: Robot, method: str, at: int, given: Any) -> st.SearchStrategy[Any]:
    """Draw another value for an argument; for a list, another value of one of its numbers."""
    kind: Any = library(robot.peer)
    taken = [*inspect.signature(getattr(kind, method)).parameters][1:]
    name = taken[min(at, len(taken) - 1)]
    if isinstance(given, list):
        return st.integers(0, len(given) - 1).flatmap(
            lambda index: _between(sorted(stated(kind, method, name, index))).map(
                lambda value: [*given[:index], value, *given[index + 1 :]]
            )
        )
    return _between(sorted(stated(kind, method, name)))


def _between(numbers: list[float]) -> st.SearchStrategy[float]:
    """Draw one of some numbers, or one of two decimals between the lowest and the highest."""
    low, high = int(min(numbers, default=0) * 100), int(max(numbers, default=255) * 100)
    hundredths = st.integers(low, high).map(lambda number: number / 100)
    return st.sampled_from(numbers) | hundredths if numbers else hundredths
