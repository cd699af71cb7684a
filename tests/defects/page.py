"""Write the results as tables, for the terminal and between the markers of the page."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from textwrap import shorten

from defects.judging import Judgement, Message
from defects.key import SUBJECTS

BEGIN, END = "<!-- defects: written by make defects -->", "<!-- end of defects -->"
# A message is cut to this many characters in the table.
MOST = 240


def tables(judgements: Sequence[Judgement], correct: Mapping[str, Sequence[Message]]) -> str:
    """Return the figures of each subject, and each defect with the message that names it.

    ``correct`` holds the failures of each subject without a defect, by subject.
    """
    return "\n".join([*_figures(judgements, correct), "", *_each(judgements)])


def _figures(
    judgements: Sequence[Judgement], correct: Mapping[str, Sequence[Message]]
) -> Iterator[str]:
    yield "| subject | defects | found | cause named | correct subject |"
    yield "|---|--:|--:|--:|---|"
    for subject, title in SUBJECTS.items():
        mine = [each for each in judgements if each.defect.subject == subject]
        if mine:
            yield f"| {title} | {_counts(mine)} | {_passed(correct.get(subject))} |"
    yield f"| all | {_counts(judgements)} | |"


def _counts(judgements: Sequence[Judgement]) -> str:
    found = sum(each.found for each in judgements)
    return f"{len(judgements)} | {found} | {sum(each.named is not None for each in judgements)}"


def _passed(failures: Sequence[Message] | None) -> str:
    if failures is None:
        return "there is none"
    return f"{len(failures)} failures" if failures else "conforms"


def _each(judgements: Sequence[Judgement]) -> Iterator[str]:
    yield "| subject | planted defect | cause named | message, and how many others the run has |"
    yield "|---|---|---|---|"
    for each in judgements:
        named = "yes" if each.named else "no" if each.found else "**not found**"
        yield f"| {each.defect.subject} | {each.defect.what} | {named} | {_message(each)} |"


def _message(judgement: Judgement) -> str:
    """Return the message that names the cause, or else the first one."""
    if not judgement.messages:
        return ""
    chosen = judgement.named or judgement.messages[0]
    text = f"`{chosen.case}` {chosen.command}: {chosen.text}".replace("|", "/")
    # Programs are built in temporary folders.
    text = re.sub(r"/\S*/(?=firmware-|client-)", "", text)
    text = shorten(text, MOST, placeholder=" ...")
    others = len(judgement.messages) - 1
    return f"{text} (+{others})" if others else text


def rewritten(page: str, text: str) -> str:
    """Return a page with another text between the markers.

    Raises:
        ValueError: the page lacks a marker.
    """
    before, rest = page.split(BEGIN, 1)
    _, after = rest.split(END, 1)
    return f"{before}{BEGIN}\n\n{text}\n\n{END}{after}"
