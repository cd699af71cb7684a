"""Check the names in a spec, by kind; they become identifiers in the generated code."""

from __future__ import annotations

import keyword
import re

LOWER = r"^[a-z][a-z0-9_]*$"
UPPER = r"^[A-Z][A-Z0-9_]*$"
# A method may keep the maker's capitals: set_HTS_gripper_torque.
METHOD = r"^[a-z][A-Za-z0-9_]*$"
CLASS = r"^[A-Z][A-Za-z0-9]*$"
ADDRESS = f"{LOWER}|{UPPER}"
CASE = r"^([A-Z][A-Z0-9_]*|-?[0-9]+)$"
FILE = r"\.yaml$"
# An edition of an installed package: cobotwire:mycobot280.
IN_PACKAGE = r"^[a-z_][a-z0-9_]*:[a-z][a-z0-9_]*$"
BASE = f"{FILE}|{IN_PACKAGE}"

_EXAMPLES = {
    LOWER: "speed",
    UPPER: "CLOCKWISE",
    METHOD: "get_angles",
    CLASS: "MyCobot",
    ADDRESS: "LEFT",
    CASE: "CLOCKWISE, or a number",
    BASE: "robot.yaml, or cobotwire:mycobot280",
}
LONGEST_NAME = 80


def wrong_name(name: str, pattern: str) -> str:
    """Return why a name is not legal for its kind; empty if it is."""
    shown = name if len(name) <= LONGEST_NAME else f"{name[:LONGEST_NAME]}..."
    example = _EXAMPLES.get(pattern, f"the pattern {pattern}")
    # "$" would also match before a line feed at the end.
    if not re.search(pattern, name) or "\n" in name or keyword.iskeyword(name):
        return f"{shown} is not a valid name; write it like {example}"
    if len(name) > LONGEST_NAME and pattern != BASE:
        return f"{shown} has more than {LONGEST_NAME} characters, the limit of a name"
    return ""
