"""Show the results of a run on a terminal."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from textwrap import shorten

from defects.key import SUBJECTS
from defects.verdicts import DefectVerdict, Message

# A message is cut to this many characters.
MOST = 240


def figures(
    verdicts: Sequence[DefectVerdict], correct: Mapping[str, Sequence[Message]]
) -> Iterator[str]:
    """Yield a row for each subject.

    ``correct`` holds the failures of each subject without a defect, by subject.
    """
    yield _row("subject", "defects", "found", "named", "correct subject")
    for subject, title in SUBJECTS.items():
        mine = [each for each in verdicts if each.defect.subject == subject]
        if mine:
            yield _row(title, *_counts(mine), _passed(correct.get(subject)))
    yield _row("all", *_counts(verdicts), "")


def _row(title: str, *columns: object) -> str:
    *counts, correct = columns
    return f"{title:26}" + "".join(f"{count:>9}" for count in counts) + f"   {correct}".rstrip()


def _counts(verdicts: Sequence[DefectVerdict]) -> tuple[int, int, int]:
    found = sum(each.found for each in verdicts)
    return len(verdicts), found, sum(each.named is not None for each in verdicts)


def _passed(failures: Sequence[Message] | None) -> str:
    if failures is None:
        return "not tested"
    return f"{len(failures)} failures" if failures else "conforms"


def line(verdict: DefectVerdict) -> str:
    """Return what was found of a defect, with the message that names it, or else the first one."""
    word = "named" if verdict.named else "found" if verdict.found else "MISSED"
    defect = verdict.defect
    text = f"{word:7}{defect.subject} {defect.switch}: {defect.what}"
    if not verdict.messages:
        return text
    # Programs are built in temporary folders.
    message = re.sub(r"/\S*/(?=firmware-|client-)", "", str(verdict.named or verdict.messages[0]))
    others = len(verdict.messages) - 1
    return f"{text}\n       {shorten(message, MOST, placeholder=' ...')}" + f" (+{others})" * bool(
        others
    )
