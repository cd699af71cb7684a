"""The plans of all pages. Other pages have no command, and no program that needs a plan."""

from __future__ import annotations

from newcomer.website.planned import Plan
from newcomer.website.plans import captures, conformance, guides, readme

PLANS: dict[str, Plan] = {
    "README.md": readme.README,
    "docs/index.md": readme.INDEX,
    "docs/start.md": readme.START,
    "docs/cli.md": readme.CLI,
    "docs/guide/add-command.md": readme.ADD_COMMAND,
    "docs/confirm-your-robot.md": guides.CONFIRM,
    "docs/guide/drive.md": guides.DRIVE,
    "docs/simulation.md": guides.SIMULATION,
    "docs/studio.md": guides.STUDIO,
    "docs/lerobot.md": guides.LEROBOT,
    "docs/mcp.md": guides.MCP,
    "docs/ros2.md": guides.ROS2,
    "docs/urdf.md": guides.URDF,
    "docs/tap.md": guides.TAP,
    "docs/pymycobot.md": guides.PYMYCOBOT,
    "docs/contribute/attack.md": guides.ATTACK,
    "docs/contribute/searches.md": guides.SEARCHES,
    "docs/c.md": guides.C,
    "docs/targets.md": guides.TARGETS,
    "docs/captures.md": captures.CAPTURES,
    "docs/export.md": captures.EXPORT,
    "docs/archives.md": captures.ARCHIVES,
    "docs/columns.md": captures.COLUMNS,
    "docs/diagnosis.md": captures.DIAGNOSIS,
    "docs/wireshark.md": captures.WIRESHARK,
    "docs/conformance.md": conformance.CONFORMANCE,
}
