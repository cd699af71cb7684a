"""Find the command of each control of the page, by the effects that an edition states."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping
from typing import Any, NamedTuple

from cobotwire.protocol.effects import Effect, Moves, Sets, each_case, effect_of
from cobotwire.protocol.fields import named_fields
from cobotwire.protocol.limits import joint_limits
from cobotwire.protocol.table import Command, Table
from cobotwire.simulator.moves import FORWARD
from cobotwire.studio.forms import elements

# The value of a direction that means backward, in every edition.
BACKWARD = 0


class ControlCommand(NamedTuple):
    """The command that a control sends.

    Attributes:
        command: the name of the command.
        arguments: the argument for each part of the control: ``at`` the joint or axis, ``to`` the
            target, ``speed`` and so on.
        places: the values of ``at``: one for each joint or axis, in their order.
        elements: the numbers of the target: name, unit and range of each.
    """

    command: str
    arguments: Mapping[str, str]
    places: list[int]
    elements: list[dict[str, Any]]


def controls(table: Table, refused: Container[str] = ()) -> dict[str, Any]:
    """Return what each control of the page sends, as JSON values; None: the edition has none.

    ``joint`` moves one joint to a target, ``coordinate`` moves the end along or about one axis, and
    ``joints`` moves all joints. If ``joint`` has no argument ``at``, it moves all joints too.
    ``jogJoint`` and ``jogCoordinate`` move until stop. ``home`` is the pose with all joints at
    zero, if the limits allow it. Commands that are ``refused`` serve no control.
    """
    found = dict.fromkeys(
        ("joint", "joints", "coordinate", "jogJoint", "jogCoordinate", "gripper", "light", "power")
    )
    for command in table.commands:
        if command.name in refused:
            continue
        for name, arguments in _uses(command):
            if found[name] is None and _suffices(command, arguments):
                found[name] = _control(command, arguments, table.joints)._asdict()
    # Without a command for a single joint, the page sends the targets of all joints.
    found["joint"] = found["joint"] or found["joints"]
    reachable = all(low <= 0 <= high for low, high in joint_limits(table))
    speeds = [each for each in (found["joint"], found["joints"]) if each]
    return {
        **found,
        "home": [0] * table.joints if found["joints"] and reachable else None,
        "speeds": _range(table, speeds[0]) if speeds else None,
        "forward": FORWARD,
        "backward": BACKWARD,
    }


def _uses(command: Command) -> Iterator[tuple[str, dict[str, str]]]:
    """Yield the controls that a command could serve, each with the arguments that it needs."""
    effect = effect_of(command)
    if command.event:
        return
    if isinstance(effect, Moves):
        yield from _motions(command, effect)
    elif command.role == "light":
        yield "light", {name: name for name in ("red", "green", "blue")}
    elif any(map(_gives_power, each_case(effect))):
        yield "power", {}


def _motions(command: Command, effect: Moves) -> Iterator[tuple[str, dict[str, str]]]:
    to, speed = str(effect.to), {"speed": effect.speed}
    if effect.part == "joint" and effect.until:
        yield "jogJoint", {"at": effect.at[0], "direction": effect.direction, **speed}
    elif effect.part == "end" and effect.until and not effect.keeps:
        yield "jogCoordinate", {"at": effect.about, "direction": effect.direction, **speed}
    elif command.role == "joint target":
        yield "joint", {"at": effect.at[0], "to": to, **speed}
    elif command.role == "joint targets":
        yield "joints", {"to": to, **speed}
    elif command.role == "coordinate target":
        yield "coordinate", {"at": effect.about, "to": to, **speed}
    elif effect.part == "gripper" and isinstance(effect.to, str):
        yield "gripper", {"to": to, **speed}


def _gives_power(effect: Effect) -> bool:
    return isinstance(effect, Sets) and effect.values.get("powered") is True


def _suffices(command: Command, arguments: Mapping[str, str]) -> bool:
    """Return whether a command needs no other arguments, and has all of these."""
    fields = named_fields(command.request)
    needed = {
        name
        for name, found in fields.items()
        if len(found) == len(command.request) and all(f.default is None for f in found)
    }
    return needed <= set(arguments.values()) <= {*fields}


def _control(command: Command, arguments: Mapping[str, str], joints: int) -> ControlCommand:
    fields = named_fields(command.request)
    picker, target = (fields.get(arguments.get(part, ""), (None,))[0] for part in ("at", "to"))
    cases = target.cases if target else ()
    # The range of a target can depend on the joint or the axis.
    chosen = sorted((when, case) for case in cases for when in case.when or (0,))
    numbers = [element for _, case in chosen for element in elements(case.numbers)]
    places = [] if picker is None else list(picker.choices) or list(range(1, joints + 1))
    return ControlCommand(command.name, dict(arguments), places, numbers)


def _range(table: Table, control: Mapping[str, Any]) -> dict[str, Any]:
    field = named_fields(table.command(control["command"]).request)[control["arguments"]["speed"]]
    return elements(field[0].cases[0].numbers)[0]
