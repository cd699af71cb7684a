"""Find the commands that could exceed limits whatever their arguments are."""

from __future__ import annotations

from cobotwire.protocol.effects import Stores, effect_of
from cobotwire.protocol.error_texts import error_text
from cobotwire.protocol.limits import Limits, is_speed
from cobotwire.protocol.roles import moves_arm
from cobotwire.protocol.table import Command, Table

# The states that decide what coordinates mean: the point of the arm, and the frame of reference.
_FRAMES = frozenset({"tool", "world", "reference_frame", "end_type"})


def refusals(table: Table, limits: Limits) -> dict[str, str]:
    """Return the commands that are not sent within ``limits``, each with the reason.

    These are persistent writes, because they can change what limits mean. With a workspace they are
    also motions to an unknown position, and settings that change what coordinates mean. With a
    speed they are also motions that take no percentage.
    """
    found = {}
    for command in table.commands:
        kind = ""
        limited = limits.workspace is not None or limits.speed is not None
        if limited and command.safety == "persistent write":
            kind = "refused-lasting"
        elif limits.workspace is not None:
            kind = _leaves_workspace(table, command)
        if limits.speed is not None and not kind and moves_arm(table, command):
            capped = all(any(map(is_speed, variant.fields)) for variant in command.request)
            kind = "" if capped else "refused-speedless"
        if kind:
            found[command.name] = error_text(kind, command=command.name, edition=table.edition)
    return found


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
