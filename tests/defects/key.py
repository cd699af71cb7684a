"""The key: every planted defect, and what a message must name. It is written before the runs."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from ruamel.yaml import YAML

from cobotwire.conformance import Report

HERE = Path(__file__).parent
# The subjects, each with its own file.
SUBJECTS = ("arm", "closed_loop", "two_arms", "firmware", "server", "client", "c_client")
# A defect of the transport as a whole: the message may be about any command.
ANY = "*"


class Defect(NamedTuple):
    """A planted defect.

    ``switch`` turns it on. ``what`` describes it. A message names it if it is about one of the
    commands in ``names``, or mentions one, and has all patterns in ``words``. ``line`` is what the
    referee does to replies, if the subject is a client.
    """

    subject: str
    switch: str
    what: str
    names: Sequence[str]
    words: Sequence[str]
    line: str = ""


class Message(NamedTuple):
    """What a report says of one failure; ``command`` is empty if it is about the whole line."""

    case: str
    command: str
    text: str


def defects() -> Iterator[Defect]:
    """Yield all defects of all subjects."""
    for subject in SUBJECTS:
        entries = YAML(typ="safe").load((HERE / f"key_{subject}.yaml").read_text("utf-8"))
        for switch, entry in entries.items():
            yield Defect(subject, switch, **entry)


def messages_of(report: Report) -> list[Message]:
    """Return what a report says of its failures, and why it ended early, if it did."""
    found = [
        Message(result.case, result.command, " | ".join((result.reason, *result.further)))
        for result in report.failures
    ]
    return found + ([Message("run ended", "", report.stopped)] if report.stopped else [])


def naming(defect: Defect, messages: Sequence[Message]) -> list[Message]:
    """Return the messages that name a command of the defect and match every pattern."""
    return [
        message
        for message in messages
        if {ANY, message.command, *re.findall(r"\w+", message.text)} & {*defect.names}
        and all(re.search(word, " ".join(message), re.IGNORECASE) for word in defect.words)
    ]
