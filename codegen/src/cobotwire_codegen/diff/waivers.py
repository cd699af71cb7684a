"""Reads and applies waivers: accepted findings, each with its rule, place and reason."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from cobotwire_codegen.diff.finding import Finding
from cobotwire_codegen.diff.rules import RULES
from cobotwire_codegen.errors import Place, Problem, SpecError, nearest
from cobotwire_codegen.language.records import Record, required
from cobotwire_codegen.language.shapes import Text
from cobotwire_codegen.load import Node, load
from cobotwire_codegen.load import Sequence as Listed
from cobotwire_codegen.reader import Reader


class WaiverEntry(Record):
    """An entry of a waivers file."""

    rule = required(Text(), "The rule of the finding.")
    where = required(Text(), "The place of the finding.")
    reason = required(Text(), "Why the finding is accepted.")


@dataclass(frozen=True, slots=True)
class Waiver:
    """One accepted finding. It names one place, so that it cannot hide a later finding."""

    place: Place
    rule: str
    where: str
    reason: str


def read_waivers(path: Path) -> tuple[Waiver, ...]:
    """Return the waivers of a file.

    Raises:
        SpecError: the file cannot be read, or an entry lacks its reason or names an unknown rule.
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
    spec = WaiverEntry
    reader = Reader(node, spec, "a waiver", problems)
    rule = reader.get(spec.rule)
    if rule and rule not in RULES:
        message = f"there is no rule {rule}{_near(rule)}"
        reader.problem("unknown-rule", message, reader.place_of(spec.rule))
    return Waiver(node.place, rule, reader.get(spec.where), reader.get(spec.reason))


def _near(rule: str) -> str:
    hint = nearest(rule, RULES)
    # The whole list would hide the problem.
    return hint if "did you mean" in hint else "; `cobotwire-gen diff --rules` lists them"


@dataclass(frozen=True, slots=True)
class Outcome:
    """The findings that are not waived, the waived ones with their waivers, and unused waivers."""

    findings: tuple[Finding, ...]
    waived: tuple[tuple[Finding, Waiver], ...]
    unused: tuple[Waiver, ...]


def apply_waivers(findings: Sequence[Finding], waivers: Sequence[Waiver]) -> Outcome:
    """Separate the findings that are waived from the others."""
    known = {(waiver.rule, waiver.where): waiver for waiver in reversed(waivers)}
    keys = {(finding.rule, finding.where) for finding in findings}
    return Outcome(
        findings=tuple(one for one in findings if (one.rule, one.where) not in known),
        waived=tuple(
            (one, known[one.rule, one.where]) for one in findings if (one.rule, one.where) in known
        ),
        unused=tuple(waiver for waiver in waivers if (waiver.rule, waiver.where) not in keys),
    )
