"""The examples of docs/codec-protocol.md are answers of the reference codec."""

from __future__ import annotations

import json
from itertools import pairwise

import pytest

import vectors
from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.conformance.codec.questions.question import Json
from cobotwire.editions.mycobot280 import TABLE

PAGE = (vectors.ROOT / "docs" / "codec-protocol.md").read_text("utf-8")
LINES = [json.loads(line) for line in PAGE.splitlines() if line.startswith('    {"id"')]
# The greeting names the codec, and a codec chooses its abilities.
EXAMPLES = [
    (question, answer)
    for question, answer in pairwise(LINES)
    if question.get("do", "hello") != "hello" and question["id"] == answer["id"]
]


@pytest.mark.parametrize(("question", "answer"), EXAMPLES, ids=str)
def test_example_is_answered_as_the_page_says(question: Json, answer: Json) -> None:
    given = {"id": question["id"], **OurCodec(ReferenceCodec(TABLE)).ask(question)}
    assert {name: given.get(name) for name in answer} == answer
    assert ("error" in given) == ("error" in answer)


def test_page_has_an_example_of_each_question() -> None:
    assert {question["do"] for question, _ in EXAMPLES} == {"encode", "decode", "stream"}
    assert len(EXAMPLES) == len({question["id"] for question, _ in EXAMPLES}) == 13
