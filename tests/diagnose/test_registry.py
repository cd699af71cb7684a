"""Check that each class of noise is complete: listed, documented, with advice."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cobotwire.codec.interface import Codec
from cobotwire.diagnose import CLASSES, Finding, Summary
from cobotwire.inspect.advice import problems_in
from diagnosing import READ, diagnose

DOCS = Path(__file__).parents[2] / "docs/diagnosis.md"


def test_every_class_of_noise_is_listed_once_under_its_own_kind() -> None:
    # By name: a dataclass with slots is made twice.
    assert {each.__name__ for each in CLASSES} == {c.__name__ for c in Finding.__subclasses__()}
    assert len({each.kind for each in CLASSES}) == len(CLASSES)


@pytest.mark.parametrize("listed", CLASSES)
def test_class_of_noise_has_a_row_in_the_docs_and_advice(listed: type[Finding]) -> None:
    rows = re.findall(r"^\| (.*?) \|", DOCS.read_text(encoding="utf-8"), re.MULTILINE)
    assert any(f"`{listed.kind}`" in row for row in rows)
    assert listed.advice


def test_problems_are_in_the_order_of_the_registry_with_the_advice_of_their_class(
    codec: Codec,
) -> None:
    items = diagnose(codec, b"ready to move\r\n" + READ + b"cmd_len error\r\n" + bytes(9))
    found = [item for item in items if isinstance(item, Finding)]
    problems = problems_in(Summary(found))
    assert [problem.kind for problem in problems] == ["nuls", "cmd-len-error", "servo", "text"]
    assert [problem.serious for problem in problems] == [True, True, True, False]
    advice = {each.kind: each.advice for each in CLASSES}
    assert all(problem.advice == advice[problem.kind] for problem in problems)
