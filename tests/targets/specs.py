"""The protocols of the tests: every type of the language, and frames of every kind."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import vectors
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.model import Edition

TESTS = vectors.ROOT / "tests"
FOLDERS = (TESTS / "codegen" / "families", TESTS / "protocols")
FILES = {path.stem: path for folder in FOLDERS for path in sorted(folder.glob("*.yaml"))}
# A few commands of shipped editions, for frames with a CRC, and with an address and a sum.
PARTS = {
    "mercury_a1": {
        *("get_angles", "send_angles", "motion_ended", "set_joint_min_angle"),
        *("set_joint_max_angle", "set_gripper_enabled", "get_gripper_mode"),
    },
    "mybuddy": {"power_on", "get_angles", "send_angle", "send_angles"},
}
SPECS = [*FILES, *PARTS]


@lru_cache
def edition_of(name: str) -> Edition:
    """Return one of the protocols: the checked edition of a file, or a part of a shipped one."""
    if name in FILES:
        edition = build_edition(FILES[name], FILES[name].parent)
        check(edition)
        return edition
    edition, names = vectors.edition(name), PARTS[name]
    families = (
        replace(family, commands=tuple(c for c in family.commands if c.name in names))
        for family in edition.families
    )
    return replace(
        edition,
        name=f"{name}_part",
        families=tuple(family for family in families if family.commands),
        vectors=tuple(v for v in edition.vectors if v.command in names),
    )
