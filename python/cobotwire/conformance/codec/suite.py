"""The test cases for codecs, and the questions that test them, in their order."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cobotwire.codec.interface import Codec
from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.codec.questions import frames, malformed, streams
from cobotwire.conformance.codec.questions.question import Question
from cobotwire.conformance.suite import Group, Suite, TestCase
from cobotwire.protocol.table import Table

# Derives questions from an edition's table; the argument is the reference codec.
Derive = Callable[[Codec], Iterator[Question]]

SOURCE = "docs/codec-protocol.md"
ANSWERS = TestCase(
    "answers",
    "Every question is answered in time by one line of the line protocol.",
    SOURCE,
    timed=True,
)

FROM_TABLE: tuple[Group[Derive], ...] = (
    frames.ENCODING,
    frames.REJECTED_VALUES,
    frames.DECODING,
    frames.REJECTED_NUMBERS,
    malformed.DAMAGED,
    malformed.EVERY_ID,
    malformed.SHARED_IDS,
    malformed.OTHER_COMMANDS,
    streams.STREAMS,
)
SUITE: Suite[Derive | None] = Suite(
    "codec",
    (
        *FROM_TABLE,
        Group("line protocol", (ANSWERS,), None, subject="all questions"),
    ),
)


def derive_questions(table: Table) -> Iterator[Question]:
    """Yield every question of an edition in a stable order; names are unique."""
    codec: Codec = ReferenceCodec(table)
    seen: dict[str, Question] = {}
    for group in FROM_TABLE:
        for question in group.body(codec):
            first = seen.setdefault(question.name, question)
            if first is question:
                yield question
            else:
                assert first.ask == question.ask, f"{question.name} names two questions"
