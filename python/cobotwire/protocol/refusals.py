"""Find the commands that could exceed limits whatever their arguments are."""

from __future__ import annotations

from cobotwire.protocol.effects import Stores, effect_of
from cobotwire.protocol.limits import Limits, is_speed
from cobotwire.protocol.roles import moves_arm
from cobotwire.protocol.table import Command, Table

# The state that decides what coordinates mean: of the end or a tool, from the base or the world.
_FRAMES = frozenset({"tool", "world", "reference_frame", "end_type"})


def refusals(table: Table, limits: Limits) -> dict[str, str]:
    """Return the commands that are not sent within ``limits``, each with the reason.

    These are writes that stay, to a servo or to the arm: they can change what limits mean. With a
    workspace they are also the motions to a place that is not known before they are sent, and
    the settings that change what coordinates mean; with a speed, motions that take no percentage.
    """
    found = {}
    for command in table.commands:
        why = ""
        limited = limits.workspace is not None or limits.speed is not None
        if limited and command.safety == "persistent write":
            why = "its effect stays, and limits.speed or limits.workspace is set"
        elif limits.workspace is not None:
            why = _leaves_workspace(table, command)
        if limits.speed is not None and not why and moves_arm(table, command):
            capped = all(any(map(is_speed, variant.fields)) for variant in command.request)
            why = "" if capped else "limits.speed is set, and it takes no speed in percent"
        if why:
            found[command.name] = f"{command.name}() is refused: {why}"
    return found


def _leaves_workspace(table: Table, command: Command) -> str:
    """Return why a command could leave a workspace whose ranges its targets keep; or nothing."""
    effect = effect_of(command)
    if isinstance(effect, Stores) and not _FRAMES.isdisjoint(effect.values.values()):
        return "it changes what coordinates mean, and limits.workspace is set"
    if not moves_arm(table, command) or command.role in ("coordinate targets", "coordinate target"):
        return ""
    if command.role != "joint targets":
        return "limits.workspace is set, and where the end would go is not known before"
    if table.robot.geometry is None:
        return f"limits.workspace is set, and edition {table.edition} states no geometry"
    return ""
