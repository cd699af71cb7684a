"""The C code agrees with every vector, built by each compiler, under the sanitizers."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

import vectors
from cobotwire_codegen.targets.vectors.document import document
from strategies import TABLES
from targets.c.comparison import compare, validated
from targets.c.compiled import missing
from targets.specs import SPECS, edition_of
from targets.vectors.comparison import read, sample
from wrong_models import WRONG, with_wrong_angles

EDITIONS = sorted(TABLES)
QUICK = ("-O0",)
WITH_GCC = pytest.mark.skipif(bool(missing("gcc")), reason=missing("gcc"))


@pytest.mark.parametrize(
    ("name", "compiler"),
    [
        pytest.param(*row, marks=pytest.mark.skipif(bool(missing(row[1])), reason=missing(row[1])))
        for row in (*((name, "gcc") for name in EDITIONS), ("mycobot280", "clang"))
    ],
)
def test_c_code_agrees_with_every_vector(name: str, compiler: str) -> None:
    found = validated(read(name), vectors.edition(name), compiler)
    assert found.differences == []
    assert found.vectors > 1000
    assert found.fields > 300


@WITH_GCC
@pytest.mark.parametrize("name", sorted(SPECS))
def test_c_code_of_other_types_and_frames_agrees_with_vectors(name: str) -> None:
    edition = edition_of(name)
    found = validated(json.loads(document(edition)), edition, "gcc")
    assert found.differences == []
    assert found.vectors > 50


@WITH_GCC
def test_c_code_refuses_values_that_a_case_does_not_list() -> None:
    found = sample("mycobot320", "set_pro_gripper")
    assert any(r["name"] == "set_pro_gripper request, value 2" for r in found["rejected"])
    edition = vectors.edition("mycobot320")
    assert validated(found, edition, "gcc", QUICK, "sample320").differences == []


@WITH_GCC
@pytest.mark.parametrize("kind", WRONG)
def test_c_code_of_a_wrong_model_differs_from_the_vectors(kind: str) -> None:
    # The changed quantity gets a new name, since a quantity has one scale wherever it is used.
    wrong = with_wrong_angles(
        vectors.edition("mycobot"), lambda part: replace(WRONG[kind](part), name="wrong_angle")
    )
    found = validated(read("mycobot"), wrong, "gcc", QUICK, kind).differences
    assert found
    assert all("get_angles" in difference or "streams" in difference for difference in found)


@WITH_GCC
def test_report_counts_what_the_tests_compare() -> None:
    assert compare("mycobot") == validated(read("mycobot"), vectors.edition("mycobot"), "gcc")
