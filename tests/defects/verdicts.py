"""Decide by a fixed rule whether the messages of a run name the cause of a planted defect."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from cobotwire.conformance import Report
from defects.key import ANY, Defect


class Message(NamedTuple):
    """What a report says of one failure; ``command`` is empty if it is about the whole line."""

    case: str
    command: str
    text: str

    def __str__(self) -> str:
        return f"{f'{self.case} {self.command}'.rstrip()}: {self.text}"


class DefectVerdict(NamedTuple):
    """What a run found of a defect. ``named`` is the message that names it, or None."""

    defect: Defect
    messages: tuple[Message, ...]
    named: Message | None

    @property
    def found(self) -> bool:
        """Whether any test case failed, or the run could not end."""
        return bool(self.messages)


def messages_of(report: Report) -> list[Message]:
    """Return what a report says of its failures, and why it ended early, if it did."""
    found = [
        Message(result.case, result.command, " | ".join((result.reason, *result.further)))
        for result in report.failures
    ]
    return found + ([Message("run ended", "", report.stopped)] if report.stopped else [])


def verdict_on(defect: Defect, messages: Sequence[Message]) -> DefectVerdict:
    """Return the verdict: one of the messages must name a command and match every pattern."""
    named = next((message for message in messages if _names(defect, message)), None)
    return DefectVerdict(defect, tuple(messages), named)


def _names(defect: Defect, message: Message) -> bool:
    text = f"{message.case} {message.command} {message.text}"
    about = {message.command, *re.findall(r"\w+", message.text)}
    if ANY not in defect.names and not about & set(defect.names):
        return False
    return all(re.search(word, text, re.IGNORECASE) for word in defect.words)
