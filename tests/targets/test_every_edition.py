"""A sample of the vectors of each edition agrees with the codecs and the targets.

``make targets`` compares all vectors, in all targets.
"""

from __future__ import annotations

import pytest

import vectors
from strategies import codec_of
from targets.c.comparison import validated as validated_in_c
from targets.c.compiled import missing
from targets.vectors.comparison import CODECS, Record, read, validated

PARTS = ("messages", "rejected", "malformed", "streams", "texts")
STEP = 9


def sample(name: str, command: str = "") -> Record:
    """Return a part of an edition's document, with every vector of one command."""
    document = read(name)
    return document | {
        part: [
            record
            for at, record in enumerate(document[part])
            if at % STEP == 0 or record.get("command") == command
        ]
        for part in PARTS
    }


@pytest.mark.parametrize("name", [n for n in vectors.further() if n in vectors.sampled()])
def test_sample_of_vectors_agrees_with_both_codecs(name: str) -> None:
    for codec in CODECS:
        found = validated(sample(name, "set_pro_gripper"), codec_of(name, codec))
        assert found.differences == []
        assert found.refused > 20


@pytest.mark.skipif(bool(missing("gcc")), reason=missing("gcc"))
def test_c_code_refuses_values_that_a_case_does_not_list() -> None:
    document = sample("mycobot320", "set_pro_gripper")
    assert any(r["name"] == "set_pro_gripper request, value 2" for r in document["rejected"])
    found = validated_in_c(document, vectors.edition("mycobot320"), "gcc", ("-O0",), "sample320")
    assert found.differences == []
