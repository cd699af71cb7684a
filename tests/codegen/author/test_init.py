"""``cobotwire-gen init`` writes a file that passes the check unchanged."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from jsonschema import Draft7Validator

from cobotwire_codegen.load import load
from codegen.author import samples


def test_file_from_init_passes_check_and_build(tmp_path: Path) -> None:
    assert samples.run(tmp_path, "init", "my_oven").returncode == 0
    checked = samples.run(tmp_path, "check", "my_oven.yaml")
    assert checked.stdout == "1 edition(s), no problems\n"
    built = samples.run(tmp_path, "build", "my_oven.yaml", "--out", "my_oven")
    assert built.returncode == 0, built.stderr
    assert "class MyOven(" in (tmp_path / "my_oven/client.py").read_text()


def test_init_writes_a_schema_that_accepts_the_file(tmp_path: Path) -> None:
    samples.run(tmp_path, "init", "oven")
    first = (tmp_path / "oven.yaml").read_text().splitlines()[0]
    assert first == "# yaml-language-server: $schema=oven.schema.json"
    schema = json.loads((tmp_path / "oven.schema.json").read_text())
    found = list(Draft7Validator(schema).iter_errors(samples.plain(load(tmp_path / "oven.yaml"))))
    assert found == []
    fresh = samples.run(tmp_path, "schema", "oven.yaml", "--out", "oven.schema.json", "--check")
    assert fresh.stdout == "fresh\n"


@pytest.mark.parametrize("there", ["oven.yaml", "oven.schema.json"])
def test_init_overwrites_no_file(tmp_path: Path, there: str) -> None:
    (tmp_path / there).write_text("mine")
    result = samples.run(tmp_path, "init", "oven")
    assert result.returncode == 2
    assert there in result.stderr
    assert [path.read_text() for path in tmp_path.iterdir()] == ["mine"]


@pytest.mark.parametrize(
    ("name", "message"),
    [("My-Oven", "like my_device"), ("class", "bad-name"), ("../x", "my_device")],
)
def test_init_rejects_an_invalid_name(tmp_path: Path, name: str, message: str) -> None:
    result = samples.run(tmp_path, "init", name)
    assert result.returncode == 2
    assert message in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_init_writes_to_the_given_file(tmp_path: Path) -> None:
    assert samples.run(tmp_path, "init", "oven", "--out", "spec.yaml").returncode == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["spec.schema.json", "spec.yaml"]
    assert samples.run(tmp_path, "init", "oven", "--out", "no/spec.yaml").returncode == 2
