"""Find the commands that could exceed limits whatever their arguments are."""

from __future__ import annotations

from cobotwire.protocol.effects import Moves, Reports, Stores, effect_of
from cobotwire.protocol.error_texts import error_text
from cobotwire.protocol.limits import Limits, Ranges, is_speed
from cobotwire.protocol.roles import moves_arm
from cobotwire.protocol.table import Command, Table

# The states that decide what coordinates mean: the point of the arm, and the frame of reference.
_FRAMES = frozenset({"tool", "world", "reference_frame", "end_type"})
# Those that choose a frame; 0 is the frame of the base, and the flange as the point of the arm.
_CHOSEN_FRAMES = frozenset({"reference_frame", "end_type"})
# The state that decides what a speed in percent means.
_HIGHEST_SPEED = "max_speed"


def refusals(table: Table, limits: Limits) -> dict[str, str]:
    """Return the commands that are not sent within ``limits``, each with the reason.

    With ranges for joints these are encoder targets, and motions to joint angles that the request
    does not state. With a workspace or a speed they are persistent writes, because they can change
    what limits mean. With a workspace they are also motions to an unknown position, and settings
    that change what coordinates mean. With a speed they are also motions that take no percentage,
    and settings of the highest speed, of which speeds are percentages.
    """
    found = {}
    for command in table.commands:
        kind = ""
        limited = limits.workspace is not None or limits.speed is not None
        if limited and command.safety == "persistent write":
            kind = "refused-lasting"
        elif limits.workspace is not None:
            kind = _leaves_workspace(table, command)
        if limits.speed is not None and not kind:
            kind = _exceeds_speed(table, command)
        if limits.joints is not None and any(limits.joints) and not kind:
            kind = _leaves_joints(table, command, limits.joints)
        if kind:
            found[command.name] = error_text(kind, command=command.name, edition=table.edition)
    return found


def frame_queries(table: Table) -> tuple[Command, ...]:
    """Return the queries that report 0 if coordinates are those of the flange from the base."""
    found = []
    for command in table.commands:
        effect = effect_of(command)
        if isinstance(effect, Reports) and not _CHOSEN_FRAMES.isdisjoint(effect.values.values()):
            found.append(command)
    return tuple(found)


def _exceeds_speed(table: Table, command: Command) -> str:
    """Return the kind of refusal of a command that could exceed a speed; empty if it cannot."""
    effect = effect_of(command)
    if isinstance(effect, Stores) and _HIGHEST_SPEED in effect.values.values():
        return "refused-scale"
    if not moves_arm(table, command):
        return ""
    capped = all(any(map(is_speed, variant.fields)) for variant in command.request)
    return "" if capped else "refused-speedless"


def _leaves_joints(table: Table, command: Command, joints: Ranges) -> str:
    """Return the kind of refusal of a command that could leave the ranges of joints."""
    if not moves_arm(table, command):
        return ""
    fields = [field for variant in command.request for field in variant.fields]
    units = {number.unit for field in fields for number in field.numbers}
    if "tick" in units:
        return "refused-encoders"
    effect = effect_of(command)
    if isinstance(effect, Moves) and isinstance(effect.to, int | float):
        inside = (each is None or each[0] <= effect.to <= each[1] for each in joints)
        return "" if all(inside) else "refused-joints"
    # A target, a distance or the speed of a jog has a unit.
    return "" if units - {""} else "refused-joints"


def _leaves_workspace(table: Table, command: Command) -> str:
    """Return the kind of refusal of a command that could leave a workspace; empty if it cannot."""
    effect = effect_of(command)
    if isinstance(effect, Stores) and not _FRAMES.isdisjoint(effect.values.values()):
        return "refused-frame"
    if not moves_arm(table, command) or command.role in ("coordinate targets", "coordinate target"):
        return ""
    if command.role != "joint targets":
        return "refused-blind"
    return "refused-shapeless" if table.robot.geometry is None else ""
