"""Define what several parts of the page use: signs, classes and anchors."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from cobotwire.conformance.report import Cause, Verdict
from cobotwire.conformance.reports.element import element

# The length, in characters, that long texts are shortened to.
LONGEST = 200
# The sign of each outcome, in the order in which outcomes are listed.
SIGNS = {
    (Verdict.FAIL, Cause.NONE): "✗",
    (Verdict.FAIL, Cause.UNSTABLE): "≈",
    (Verdict.INCONCLUSIVE, Cause.NOT_SUPPORTED): "○",
    (Verdict.INCONCLUSIVE, Cause.NOT_TIMED): "◷",
    (Verdict.PASS, Cause.NONE): "✓",
    (Verdict.NOT_RUN, Cause.NOT_PERMITTED): "·",
    (Verdict.NOT_RUN, Cause.NOT_SELECTED): "-",
    (Verdict.NOT_RUN, Cause.RUN_ENDED): "…",
}


def sign_of(verdict: Verdict, cause: Cause) -> str:
    """Return the sign of an outcome; ``?`` for an unknown one of another program's report."""
    return SIGNS.get((verdict, cause)) or SIGNS.get((verdict, Cause.NONE), "?")


def order_of(outcome: tuple[Verdict, Cause]) -> int:
    """Return the sort key of an outcome; unknown ones come last."""
    known = list(SIGNS)
    return known.index(outcome) if outcome in known else len(known)


def class_of(verdict: Verdict, cause: Cause) -> str:
    """Return the CSS class that gives an outcome its colour."""
    if verdict is Verdict.FAIL:
        return "unstable" if cause is Cause.UNSTABLE else "fail"
    return {Verdict.PASS: "pass", Verdict.INCONCLUSIVE: "open"}.get(verdict, "skip")


def words_of(count: int, outcome: tuple[Verdict, Cause]) -> str:
    """Return a count of an outcome in words: ``12 not run (not permitted)``."""
    verdict, cause = outcome
    return f"{count} {verdict}" + (f" ({cause})" if cause else "")


def shortened(text: str) -> str:
    """Return the start of a long text; the page shows it in full elsewhere."""
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}..."


def heading(id: str, title: str, more: str = "") -> Element:
    """Return a heading that the navigation links to."""
    return element("h2", f"{title}: {more}" if more else title, id=id)


def title_of(command: str) -> str:
    """Return a command's name; an empty one means the line as a whole."""
    return command or "the line"


def anchor(command: str) -> str:
    """Return the id of a command's entry."""
    return f"of-{command}"
