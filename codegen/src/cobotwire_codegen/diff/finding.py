"""A difference between two editions as data, and the version bump that follows."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from cobotwire_codegen.diff.rules import LEVELS, RULES, Level

Bump = Literal["major", "minor", "patch", "none"]

_BUMPS: dict[Level, Bump] = {
    "wire": "major",
    "api": "major",
    "behaviour": "minor",
    "peer": "minor",
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
    "peer": "minor",
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


def fails(findings: Iterable[Finding], fail_on: Level | None) -> bool:
    """Return whether a finding has the level ``fail_on`` or a more severe one.

    Args:
        findings: the findings that are not waived.
        fail_on: the least severe level that fails; None if nothing fails.
    """
    levels = list(LEVELS)
    failing = levels[: levels.index(fail_on) + 1] if fail_on else []
    return any(found.level in failing for found in findings)


def bump(findings: Iterable[Finding]) -> Bump:
    """Return the part of a version number, from 1.0 on, that must be raised."""
    return _highest(findings, _BUMPS)


def bump_before_1_0(findings: Iterable[Finding]) -> Bump:
    """Return the part of a version number 0.x that is raised, by convention."""
    return _highest(findings, _BUMPS_BEFORE_1_0)


def _highest(findings: Iterable[Finding], bumps: dict[Level, Bump]) -> Bump:
    return max((bumps[found.level] for found in findings), key=_ORDER.index, default="none")
