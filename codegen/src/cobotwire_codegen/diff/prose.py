"""Compares prose and evidence: docs, sources, notes, disputes, errata, vectors, changes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from cobotwire_codegen.diff import words
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.match import T, bare, match, order
from cobotwire_codegen.model import Change, Dispute, Edition, Lines, Observation, Vector


def doc(where: str, old: str, new: str) -> Iterator[Finding]:
    """Compare a description."""
    if old != new:
        yield finding("doc-changed", where, *map(words.in_quotes, (old, new)))


def source(where: str, old: Lines, new: Lines) -> Iterator[Finding]:
    """Compare the lines of the document."""
    if old != new:
        yield finding("source-changed", where, _lines(old), _lines(new))


def notes(where: str, old: Sequence[str], new: Sequence[str]) -> Iterator[Finding]:
    """Compare the notes."""
    if old != new:
        fresh = [note for note in new if note not in old]
        gone = [note for note in old if note not in new]
        shown = "; ".join(map(words.short, fresh)) or "fewer, or in another order"
        yield finding("note-changed", where, "; ".join(map(words.short, gone)), shown)


def disputes(where: str, old: Sequence[Dispute], new: Sequence[Dispute]) -> Iterator[Finding]:
    """Compare the disputes."""
    place = f"{where}/disputed"
    yield from _listed("dispute", lambda _: place, old, new, _dispute)


def _dispute(found: Dispute) -> str:
    return f"confidence {found.confidence}: {found.claim}"


def history(where: str, old: Sequence[Change], new: Sequence[Change]) -> Iterator[Finding]:
    """Compare the changes that a delta states, and their reasons."""
    if old != new and bare(old) != bare(new):
        known = [bare(change) for change in old]
        fresh = [change.what for change in new if bare(change) not in known]
        yield finding("history-changed", where, "", words.short(" ".join(fresh)) or "fewer changes")


def errata(old: Edition, new: Edition) -> Iterator[Finding]:
    """Compare the errata."""
    yield from _listed(
        "erratum",
        lambda item: f"errata/{_numbers(item.lines)}",
        old.errata,
        new.errata,
        lambda item: f'for "{item.says}" read "{item.read}"',
    )


def vectors(old: Edition, new: Edition) -> Iterator[Finding]:
    """Compare the vectors."""
    yield from _listed(
        "vector", lambda item: f"vectors/{item.name}", old.vectors, new.vectors, _vector
    )


def evidence(old: Edition, new: Edition) -> Iterator[Finding]:
    """Compare what arms showed."""
    yield from _listed(
        "evidence", lambda arm: f"evidence/{arm.digest[:8]}", old.observed, new.observed, _arm
    )


def _arm(found: Observation) -> str:
    good = sum(fact.confirmed for fact in found.facts)
    bad = len(found.facts) - good
    return f"{found.date} {found.robot}: {good} confirmed, {bad} contradicted"


def _listed(
    what: str,
    where: Callable[[T], str],
    old: Sequence[T],
    new: Sequence[T],
    shown: Callable[[T], str],
) -> Iterator[Finding]:
    if old == new:
        return
    # Equal items match first; after that, items at the same place have changed.
    matched = match(old, new, bare).further(where)
    for item in matched.removed:
        yield finding(f"{what}-removed", where(item), words.short(shown(item)))
    for item in matched.added:
        yield finding(f"{what}-added", where(item), "", words.short(shown(item)))
    for before, after in matched.pairs:
        if bare(before) != bare(after):
            parts = words.short(shown(before)), words.short(shown(after))
            yield finding(f"{what}-changed", where(after), *parts)
    yield from order(f"every {what}", matched, shown)


def _lines(found: Lines) -> str:
    return words.lines(found) if found else ""


def _numbers(found: Lines) -> str:
    return ",".join(str(a) if a == b else f"{a}-{b}" for a, b in found)


def _vector(found: Vector) -> str:
    content = words.hexed(found.frame) if found.frame is not None else found.text or "no frame"
    return f"{found.command} {found.direction} {content}"
