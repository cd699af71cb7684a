"""The patterns of names: they become names of the generated code."""

from __future__ import annotations

LOWER = r"^[a-z][a-z0-9_]*$"
UPPER = r"^[A-Z][A-Z0-9_]*$"
# A method may keep the maker's capitals: set_HTS_gripper_torque.
METHOD = r"^[a-z][A-Za-z0-9_]*$"
CLASS = r"^[A-Z][A-Za-z0-9]*$"
ADDRESS = f"{LOWER}|{UPPER}"
CASE = r"^[A-Z0-9-]"
FILE = r"\.yaml$"
# An edition of an installed package: cobotwire:mycobot280.
IN_PACKAGE = r"^[a-z_][a-z0-9_]*:[a-z][a-z0-9_]*$"
