"""Formats findings as text for people, as JSON for machines, as Markdown for the changelog."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict

from cobotwire_codegen.diff.finding import Finding, bump, bump_before_1_0
from cobotwire_codegen.diff.rules import LEVELS, Level
from cobotwire_codegen.diff.waivers import Judged, Waiver

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


def text(judged: Judged) -> Iterator[tuple[str, str]]:
    """Return the lines, each with its kind: a level for a heading, else empty."""
    for level, findings in _grouped(judged):
        yield level, f"{level} ({len(findings)}): {LEVELS[level]}"
        for one in findings:
            yield "", f"  {one.rule}: {one.where}: {one.message}"
    if judged.waived:
        yield "waived", f"waived ({len(judged.waived)}): accepted, and not counted"
    for one, waiver in judged.waived:
        yield "", f"  {one.rule}: {one.where}: {one.message}"
        yield "", f"    because: {waiver.reason}"
    for waiver in judged.unused:
        yield "unused", f"{waiver.place}: unused-waiver: {_unused(waiver)}"
    yield "", _summary(judged)


def as_json(judged: Judged, old: str, new: str) -> str:
    """Return one document; ``version`` is raised when older readers could misread it."""
    data = {
        "format": "cobotwire-diff",
        "version": VERSION,
        "old": old,
        "new": new,
        "bump": bump(judged.findings),
        "bump_before_1_0": bump_before_1_0(judged.findings),
        "findings": [asdict(one) for one in judged.findings],
        "waived": [{**asdict(one), "reason": waiver.reason} for one, waiver in judged.waived],
        "unused_waivers": [
            {"rule": one.rule, "where": one.where, "place": str(one.place)} for one in judged.unused
        ],
    }
    return json.dumps(data, indent=1)


def markdown(judged: Judged) -> Iterator[str]:
    """Return the lines for the changelog."""
    for level, findings in _grouped(judged):
        yield from (f"### {_TITLES[level]}", "")
        for one in findings:
            yield f"- `{one.where}`: {_escaped(one.message)} (`{one.rule}`)"
        yield ""
    if judged.waived:
        yield from ("### Waived", "")
    for one, waiver in judged.waived:
        reason = _escaped(waiver.reason)
        yield f"- `{one.where}`: {_escaped(one.message)} (`{one.rule}`). Waived: {reason}"
    if judged.waived:
        yield ""
    for waiver in judged.unused:
        yield from (f"> Unused waiver: {_escaped(_unused(waiver))}", "")
    yield _escaped(_summary(judged))


def _grouped(judged: Judged) -> Iterator[tuple[Level, list[Finding]]]:
    for level in LEVELS:
        findings = [one for one in judged.findings if one.level == level]
        if findings:
            yield level, findings


def _unused(waiver: Waiver) -> str:
    return f"{waiver.rule} at {waiver.where} matches nothing; remove it"


def _summary(judged: Judged) -> str:
    if not judged.findings:
        return "no difference" if not judged.waived else "no difference except those waived"
    counts = ", ".join(f"{len(found)} {level}" for level, found in _grouped(judged))
    after, before = bump(judged.findings), bump_before_1_0(judged.findings)
    return f"{counts}; version bump: {after} (before 1.0: {before})"


def _escaped(words: str) -> str:
    return "".join(_MARKS.get(mark, mark) for mark in words)
