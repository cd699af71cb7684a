"""A difference between two editions as data, and the version bump that follows."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from cobotwire_codegen.diff.rules import RULES, Level

Bump = Literal["major", "minor", "patch", "none"]

BREAKING: tuple[Level, ...] = ("wire", "api")
_BUMPS: dict[Level, Bump] = {
    "wire": "major",
    "api": "major",
    "behaviour": "minor",
    "addition": "minor",
    "docs": "patch",
}
_ORDER: tuple[Bump, ...] = ("none", "patch", "minor", "major")
# SemVer 2.0.0, item 4, promises nothing for 0.x. By convention, which Cargo's resolver enforces, a
# breaking change raises the minor number there, and any other change the patch number. A change
# of behaviour counts as breaking: an unreviewed patch must not make an arm move differently.
_BUMPS_BEFORE_1_0: dict[Level, Bump] = {
    "wire": "minor",
    "api": "minor",
    "behaviour": "minor",
    "addition": "patch",
    "docs": "patch",
}


@dataclass(frozen=True, slots=True)
class Finding:
    """One difference. ``where`` is a path into the model; ``old`` and ``new`` are texts."""

    rule: str
    level: Level
    where: str
    old: str
    new: str
    message: str


def finding(rule: str, where: str, old: object = "", new: object = "") -> Finding:
    """Return a finding of a rule; the table of rules gives its level and its message."""
    entry = RULES[rule]
    before, after = str(old), str(new)
    message = entry.message.format(old=before or "nothing", new=after or "nothing")
    return Finding(rule, entry.level, where, before, after, message)


def breaking(findings: Iterable[Finding]) -> bool:
    """Return whether a finding breaks an old peer or an old caller."""
    return any(found.level in BREAKING for found in findings)


def bump(findings: Iterable[Finding]) -> Bump:
    """Return the part of a version number, from 1.0 on, that must be raised."""
    return _highest(findings, _BUMPS)


def bump_before_1_0(findings: Iterable[Finding]) -> Bump:
    """Return the part of a version number 0.x that is raised, by convention."""
    return _highest(findings, _BUMPS_BEFORE_1_0)


def _highest(findings: Iterable[Finding], bumps: dict[Level, Bump]) -> Bump:
    return max((bumps[found.level] for found in findings), key=_ORDER.index, default="none")
