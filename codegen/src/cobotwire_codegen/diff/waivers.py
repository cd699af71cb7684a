"""Findings that somebody answers for: a list of rule, place and reason."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from cobotwire_codegen.diff.finding import Finding
from cobotwire_codegen.diff.rules import RULES
from cobotwire_codegen.errors import Place, Problem, SpecError, nearest
from cobotwire_codegen.load import Node, load
from cobotwire_codegen.load import Sequence as Listed
from cobotwire_codegen.reader import Reader


@dataclass(frozen=True, slots=True)
class Waiver:
    """One accepted finding. It has one place, so that it cannot swallow what comes later."""

    place: Place
    rule: str
    where: str
    reason: str


def read_waivers(path: Path) -> tuple[Waiver, ...]:
    """A file of waivers.

    Raises:
        SpecError: it cannot be read, an entry lacks its reason, or names no rule.
    """
    root = load(path)
    problems: list[Problem] = []
    if not isinstance(root, Listed):
        message = "waivers are a list of {rule, where, reason}"
        raise SpecError([Problem(root.place, "wrong-kind", message)])
    found = [_waiver(node, problems) for node in root.items]
    if problems:
        raise SpecError(problems)
    return tuple(found)


def _waiver(node: Node, problems: list[Problem]) -> Waiver:
    reader = Reader(node, "a waiver", problems)
    rule, where, reason = (reader.text(key) for key in ("rule", "where", "reason"))
    at = reader.node("rule")
    if at is not None and rule and rule not in RULES:
        problem = Problem(at.place, "unknown-rule", f"there is no rule {rule}{_near(rule)}")
        problems.append(problem)
    reader.done()
    return Waiver(node.place, rule, where, reason)


def _near(rule: str) -> str:
    hint = nearest(rule, RULES)
    # The whole list would bury the problem.
    return hint if "did you mean" in hint else "; `cobotwire-gen diff --rules` lists them"


@dataclass(frozen=True, slots=True)
class Judged:
    """Findings that count, findings that are waived and by what, and waivers that met nothing."""

    findings: tuple[Finding, ...]
    waived: tuple[tuple[Finding, Waiver], ...]
    unused: tuple[Waiver, ...]


def judge(findings: Sequence[Finding], waivers: Sequence[Waiver]) -> Judged:
    """Set aside what is waived."""
    known = {(waiver.rule, waiver.where): waiver for waiver in reversed(waivers)}
    keys = {(finding.rule, finding.where) for finding in findings}
    return Judged(
        findings=tuple(one for one in findings if (one.rule, one.where) not in known),
        waived=tuple(
            (one, known[one.rule, one.where]) for one in findings if (one.rule, one.where) in known
        ),
        unused=tuple(waiver for waiver in waivers if (waiver.rule, waiver.where) not in keys),
    )
