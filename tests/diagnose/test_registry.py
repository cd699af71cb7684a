"""Check that each class of noise is complete: listed, documented, with advice."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import pytest

from cobotwire.codec.interface import Codec
from cobotwire.diagnose import CLASSES, Finding, Summary, Unrecognised
from cobotwire.diagnose.recogniser import Recogniser
from cobotwire.diagnose.registry import RECOGNISERS
from cobotwire.diagnose.residue import Residue, Verdict
from cobotwire.inspect.advice import problems_in
from diagnosing import READ, diagnose, kinds

DOCS = Path(__file__).parents[2] / "docs/diagnosis.md"


def test_every_class_of_noise_is_listed_once_under_its_own_kind() -> None:
    # Compare names: a dataclass with slots is created twice.
    made = {c.__name__ for c in Finding.__subclasses__() if c.__module__ != __name__}
    assert {each.__name__ for each in CLASSES} == made
    assert len({each.kind for each in CLASSES}) == len(CLASSES)


@pytest.mark.parametrize("listed", CLASSES)
def test_class_of_noise_has_a_row_in_the_docs_and_advice(listed: type[Finding]) -> None:
    rows = re.findall(r"^\| (.*?) \|", DOCS.read_text(encoding="utf-8"), re.MULTILINE)
    assert any(f"`{listed.kind}`" in row for row in rows)
    assert listed.advice


@dataclass(frozen=True, slots=True, kw_only=True)
class Bells(Finding):
    """A class of noise that only this test knows."""

    kind: ClassVar[str] = "bells"
    advice: ClassVar[str] = "answer the door"


class BellRinger(Recogniser):
    starts = rb"\a"

    def recognise(self, residue: Residue, at: int) -> Verdict:
        return Bells(spans=residue.spans(at, at + 1), reason=residue.reason(at))


def test_registered_recogniser_finds_its_class_also_inside_other_noise(
    codec: Codec, monkeypatch: pytest.MonkeyPatch
) -> None:
    noise = b"\x03\x05\a\xc1"
    assert kinds(diagnose(codec, noise)) == [Unrecognised]
    registered = (*RECOGNISERS, BellRinger)
    monkeypatch.setattr("cobotwire.diagnose.diagnoser.RECOGNISERS", registered)
    assert kinds(diagnose(codec, noise)) == [Unrecognised, Bells, Unrecognised]


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
