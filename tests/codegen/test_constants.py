"""Constants: how vectors state them, and how they distinguish messages."""

from __future__ import annotations

from pathlib import Path

import pytest

import small_specs
from vectors import plain

SELECT = """
select:
  id: 0x10
  title: Select
  doc: Selects.
  safety: setting
  request:
    - {name: tool, type: tool, const: 14}
    - {name: lit, type: flag, const: 1}
    - {name: heat, type: warmth, const: 15}
"""
FRAME = "FE FE 06 10 0E 01 00 0F FA"


@pytest.mark.parametrize("const", ["GRIPPER", "14"])
@pytest.mark.parametrize("tool", ["GRIPPER", "14"])
@pytest.mark.parametrize("lit", ["true", "1"])
def test_constant_is_stated_by_name_or_number(
    tmp_path: Path, tool: str, lit: str, const: str
) -> None:
    values = f"{{tool: {tool}, lit: {lit}, heat: 1.5}}"
    vector = f"- {{name: v, command: select, direction: request, frame: {FRAME}, values: {values}}}"
    select = SELECT.replace("const: 14", f"const: {const}")
    assert small_specs.problems(tmp_path, select, vector) == []
    edition = small_specs.build(tmp_path, select, vector)
    [built] = edition.vectors
    values_of_codecs = [plain(edition, built, name, value) for name, value in built.values]
    assert values_of_codecs == [14, 1, 1.5]


@pytest.mark.parametrize(
    ("values", "problem"),
    [
        ("{tool: PUMP, lit: 1, heat: 1.5}", "tool is always GRIPPER"),
        ("{tool: 15, lit: 1, heat: 1.5}", "tool is always GRIPPER"),
        ("{tool: 14, lit: false, heat: 1.5}", "lit is always True"),
        ("{tool: 14, lit: 1, heat: 15}", "heat is always 3/2"),
    ],
)
def test_vector_with_another_value_than_the_constant_is_rejected(
    tmp_path: Path, values: str, problem: str
) -> None:
    vector = f"- {{name: v, command: select, direction: request, frame: {FRAME}, values: {values}}}"
    found = small_specs.problems(tmp_path, SELECT, vector)
    assert found == [f"unencodable-vector: v: {problem}"]
