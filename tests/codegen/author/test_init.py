"""A protocol of one's own starts from a file that passes as it is."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from jsonschema import Draft7Validator

from cobotwire_codegen.load import load
from codegen.author import samples
from codegen.author.schema_walk import plain


def test_the_first_file_passes_check_and_build(tmp_path: Path) -> None:
    assert samples.run(tmp_path, "init", "my_oven").returncode == 0
    checked = samples.run(tmp_path, "check", "my_oven.yaml")
    assert checked.stdout == "1 edition(s), no problem\n"
    built = samples.run(tmp_path, "build", "my_oven.yaml", "--out", "my_oven")
    assert built.returncode == 0, built.stderr
    assert "class MyOven(" in (tmp_path / "my_oven/client.py").read_text()


def test_its_schema_stands_beside_it_and_holds(tmp_path: Path) -> None:
    samples.run(tmp_path, "init", "oven")
    first = (tmp_path / "oven.yaml").read_text().splitlines()[0]
    assert first == "# yaml-language-server: $schema=oven.schema.json"
    schema = json.loads((tmp_path / "oven.schema.json").read_text())
    found = list(Draft7Validator(schema).iter_errors(plain(load(tmp_path / "oven.yaml"))))
    assert found == []
    fresh = samples.run(tmp_path, "schema", "oven.yaml", "--out", "oven.schema.json", "--check")
    assert fresh.stdout == "fresh\n"


@pytest.mark.parametrize("there", ["oven.yaml", "oven.schema.json"])
def test_nothing_is_overwritten(tmp_path: Path, there: str) -> None:
    (tmp_path / there).write_text("mine")
    result = samples.run(tmp_path, "init", "oven")
    assert result.returncode == 2
    assert there in result.stderr
    assert [path.read_text() for path in tmp_path.iterdir()] == ["mine"]


@pytest.mark.parametrize(
    ("name", "said"), [("My-Oven", "like my_device"), ("class", "bad-name"), ("../x", "my_device")]
)
def test_a_name_that_cannot_be_is_refused(tmp_path: Path, name: str, said: str) -> None:
    result = samples.run(tmp_path, "init", name)
    assert result.returncode == 2
    assert said in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_the_file_can_be_chosen(tmp_path: Path) -> None:
    assert samples.run(tmp_path, "init", "oven", "--out", "spec.yaml").returncode == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["spec.schema.json", "spec.yaml"]
    assert samples.run(tmp_path, "init", "oven", "--out", "no/spec.yaml").returncode == 2
