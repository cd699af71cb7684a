"""What a page needs to know about a robot before any traffic: joints, limits, coordinates."""

from __future__ import annotations

from typing import Any

from cobotwire.kinematics import geometry_of
from cobotwire.protocol.limits import joint_limits
from cobotwire.protocol.table import Role, Table

Facts = dict[str, Any]


def robot_facts(table: Table) -> Facts:
    """Return the facts as JSON values; a list is empty where the edition states nothing."""
    joints, coordinates = _numbers(table, "joints"), _numbers(table, "coordinates")
    geometry = geometry_of(table)
    stop, stated = table.find_role("stop"), table.robot.geometry
    reach = 0.0
    if geometry is not None:
        reach = sum(abs(link.a) + abs(link.d) for link in geometry.links)
    return {
        "edition": table.edition,
        "title": table.title,
        "joints": joints or [{"name": f"j{n + 1}", "unit": ""} for n in range(table.joints)],
        "coordinates": coordinates,
        "limits": [list(limit) for limit in joint_limits(table)],
        "reach": round(reach, 1),
        "links": [list(link) for link in stated.links] if stated is not None else [],
        "geometryRemark": table.robot.geometry_remark,
        "noGeometry": "" if geometry is not None else table.robot.why_no_geometry,
        "stop": "" if stop is None else stop.name,
    }


def _numbers(table: Table, role: Role) -> list[dict[str, str]]:
    """Return the names and units of the row of numbers that the query of a role returns."""
    query = table.find_role(role)
    rows = [f for v in query.reply[:1] for f in v.fields if f.many] if query else []
    if not rows:
        return []
    numbers = rows[0].cases[0].numbers
    return [
        {"name": number.name or f"{n + 1}", "unit": number.units}
        for n, number in enumerate(numbers)
    ]
