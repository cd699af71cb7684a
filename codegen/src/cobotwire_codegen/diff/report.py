"""Formats findings as text for people, as JSON for machines, as Markdown for the changelog."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict

from cobotwire_codegen.diff.finding import Finding, bump, bump_before_1_0
from cobotwire_codegen.diff.rules import LEVELS, Level
from cobotwire_codegen.diff.waivers import Outcome, Waiver

VERSION = 2
_TITLES: dict[Level, str] = {
    "wire": "Wire-breaking",
    "api": "API-breaking",
    "behaviour": "Behaviour",
    "peer": "Peers of other versions",
    "addition": "Additions",
    "docs": "Docs",
}
# Characters that Markdown would interpret.
_MARKS = {mark: f"\\{mark}" for mark in "\\`*_[]<>|#"}


def text(outcome: Outcome) -> Iterator[tuple[str, str]]:
    """Return pairs of a kind and a line. The kind (a level, waived, unused) selects the colour."""
    for level, findings in _grouped(outcome):
        yield level, f"{level} ({len(findings)}): {LEVELS[level]}"
        for one in findings:
            yield "", f"  {one.rule}: {one.where}: {one.message}"
    if outcome.waived:
        yield "waived", f"waived ({len(outcome.waived)}): accepted, and not counted"
    for one, waiver in outcome.waived:
        yield "", f"  {one.rule}: {one.where}: {one.message}"
        yield "", f"    because: {waiver.reason}"
    for waiver in outcome.unused:
        yield "unused", f"{waiver.place}: unused-waiver: {_unused(waiver)}"
    yield "", _summary(outcome)


def as_json(outcome: Outcome, old: str, new: str) -> str:
    """Return one document; ``version`` is raised when older readers could misread it."""
    data = {
        "format": "cobotwire-diff",
        "version": VERSION,
        "old": old,
        "new": new,
        "bump": bump(outcome.findings),
        "bump_before_1_0": bump_before_1_0(outcome.findings),
        "findings": [asdict(one) for one in outcome.findings],
        "waived": [{**asdict(one), "reason": waiver.reason} for one, waiver in outcome.waived],
        "unused_waivers": [
            {"rule": one.rule, "where": one.where, "place": str(one.place)}
            for one in outcome.unused
        ],
    }
    return json.dumps(data, indent=1)


def markdown(outcome: Outcome) -> Iterator[str]:
    """Return the lines for the changelog."""
    for level, findings in _grouped(outcome):
        yield from (f"### {_TITLES[level]}", "")
        for one in findings:
            yield f"- `{one.where}`: {_escaped(one.message)} (`{one.rule}`)"
        yield ""
    if outcome.waived:
        yield from ("### Waived", "")
    for one, waiver in outcome.waived:
        reason = _escaped(waiver.reason)
        yield f"- `{one.where}`: {_escaped(one.message)} (`{one.rule}`). Waived: {reason}"
    if outcome.waived:
        yield ""
    for waiver in outcome.unused:
        yield from (f"> Unused waiver: {_escaped(_unused(waiver))}", "")
    yield _escaped(_summary(outcome))


def _grouped(outcome: Outcome) -> Iterator[tuple[Level, list[Finding]]]:
    for level in LEVELS:
        findings = [one for one in outcome.findings if one.level == level]
        if findings:
            yield level, findings


def _unused(waiver: Waiver) -> str:
    return f"{waiver.rule} at {waiver.where} matches nothing; remove it"


def _summary(outcome: Outcome) -> str:
    if not outcome.findings:
        return "no difference" if not outcome.waived else "no difference except those waived"
    counts = ", ".join(f"{len(found)} {level}" for level, found in _grouped(outcome))
    after, before = bump(outcome.findings), bump_before_1_0(outcome.findings)
    return f"{counts}; version bump: {after} (before 1.0: {before})"


def _escaped(words: str) -> str:
    return "".join(_MARKS.get(mark, mark) for mark in words)
