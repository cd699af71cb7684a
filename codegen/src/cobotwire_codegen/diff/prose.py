"""Words and evidence: docs, sources, notes, disputes, errata, vectors, what a delta says."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from cobotwire_codegen.diff import words
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.match import T, bare, match, order
from cobotwire_codegen.model import Change, Dispute, Edition, Lines, Vector


def doc(where: str, old: str, new: str) -> Iterator[Finding]:
    """A sentence for people."""
    if old != new:
        yield finding("doc-changed", where, words.short(old), words.short(new))


def source(where: str, old: Lines, new: Lines) -> Iterator[Finding]:
    """The lines of the document that say it."""
    if old != new:
        yield finding("source-changed", where, _lines(old), _lines(new))


def notes(where: str, old: Sequence[str], new: Sequence[str]) -> Iterator[Finding]:
    """Sentences beside the description."""
    if old != new:
        fresh = [note for note in new if note not in old]
        gone = [note for note in old if note not in new]
        shown = "; ".join(map(words.short, fresh)) or "fewer, or in another order"
        yield finding("note-changed", where, "; ".join(map(words.short, gone)), shown)


def disputes(where: str, old: Sequence[Dispute], new: Sequence[Dispute]) -> Iterator[Finding]:
    """What the sources do not agree on."""
    place = f"{where}/disputed"
    yield from _listed("dispute", lambda _: place, old, new, lambda item: item.claim)


def history(where: str, old: Sequence[Change], new: Sequence[Change]) -> Iterator[Finding]:
    """What a delta edition says that it changes, and why."""
    if bare(old) != bare(new):
        known = [bare(change) for change in old]
        fresh = [change.what for change in new if bare(change) not in known]
        yield finding("history-changed", where, "", words.short(" ".join(fresh)) or "less is said")


def errata(old: Edition, new: Edition) -> Iterator[Finding]:
    """Where the document is wrong."""
    yield from _listed(
        "erratum",
        lambda item: f"errata/{_numbers(item.lines)}",
        old.errata,
        new.errata,
        lambda item: f"{item.says}: read {item.read}",
    )


def vectors(old: Edition, new: Edition) -> Iterator[Finding]:
    """Frames with their values."""
    yield from _listed(
        "vector", lambda item: f"vectors/{item.name}", old.vectors, new.vectors, _vector
    )


def _listed(
    what: str,
    where: Callable[[T], str],
    old: Sequence[T],
    new: Sequence[T],
    shown: Callable[[T], str],
) -> Iterator[Finding]:
    # What says the same is the same; else what stands at the same place has changed.
    matched = match(old, new, bare).further(where)
    for item in matched.gone:
        yield finding(f"{what}-removed", where(item), words.short(shown(item)))
    for item in matched.came:
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
    said = words.hexed(found.frame) if found.frame is not None else found.text or "no frame"
    return f"{found.command} {found.direction} {said}"
