"""The schema knows all keys and rejects others; the project and users can generate it.

``test_language.py`` tests that the schema and the reader reject the same, for each record.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft7Validator

import vectors
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.language.schema import editor_schema, schema_json
from cobotwire_codegen.load import load
from cobotwire_codegen.project import SERVO_BUS
from codegen.author import samples
from codegen.test_generator import EDITIONS, copy_spec

# Files of the spec that the schema does not describe: one has only types, one is not an edition.
OTHERS = {vectors.ROOT / SERVO_BUS, vectors.ROOT / "spec" / "pymycobot.yaml"}
FILES = sorted({*(vectors.ROOT / "spec").rglob("*.yaml")} - OTHERS)
# The values of a vector: any fields.
OPEN = {"example_vector/values", "named_vector/values"}


def _schemas(value: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    if isinstance(value, dict):
        yield path, value
        for name, inner in value.items():
            yield from _schemas(inner, (*path, name))


@pytest.fixture(scope="module")
def schema() -> dict[str, Any]:
    return editor_schema([*vectors.editions().values()])


def test_schema_lists_the_keys_of_every_mapping(schema: dict[str, Any]) -> None:
    Draft7Validator.check_schema(schema)
    known = set()
    for path, inner in _schemas(schema["definitions"]):
        if inner.get("type") == "object" and "if" not in path:
            assert "additionalProperties" in inner or f"{path[0]}/{path[-1]}" in OPEN, path
        if path[-2:-1] == ("properties",):
            assert inner.keys() & {"type", "enum", "$ref", "if", "anyOf"}, path
        if isinstance(inner.get("properties"), dict) and len(path) == 1:
            assert inner["additionalProperties"] is False, path
            known.add(path[0])
    assert len(known) > 60


def test_every_spec_file_is_valid(schema: dict[str, Any]) -> None:
    validator = Draft7Validator(schema)
    for path in FILES:
        assert list(validator.iter_errors(samples.plain(load(path)))) == [], path
    of_samples = [build_edition(samples.FOLDER / n, samples.FOLDER) for n in samples.EDITIONS]
    validator = Draft7Validator(editor_schema(of_samples))
    for path in samples.FOLDER.rglob("*.yaml"):
        if "tests" not in path.parts[-3:]:
            assert list(validator.iter_errors(samples.plain(load(path)))) == [], path


def test_types_of_every_edition_can_be_named(schema: dict[str, Any]) -> None:
    names = schema["definitions"]["type_name"]["enum"]
    assert names == sorted({t.name for e in vectors.editions().values() for t in e.types})


def test_schema_command_writes_and_compares_the_file(tmp_path: Path) -> None:
    copy_spec(tmp_path)
    path = tmp_path / "spec/schema.json"
    path.write_text("{}")
    assert samples.run(tmp_path, "schema", "--check").returncode == 1
    assert samples.run(tmp_path, "schema").returncode == 0
    assert path.read_text() == schema_json([vectors.edition(name) for name in EDITIONS])
    assert samples.run(tmp_path, "schema", "--check").stdout == "fresh\n"


def test_schema_of_a_users_protocol_lists_its_own_types(tmp_path: Path) -> None:
    folder = samples.copied(tmp_path)
    assert samples.run(folder, "schema", "lamp.yaml", "--out", "lamp.json").returncode == 0
    schema = json.loads((folder / "lamp.json").read_text())
    assert schema["definitions"]["wire_name"]["enum"] == ["byte", "word"]
    assert samples.run(folder, "schema", "lamp.yaml").returncode == 2


def test_every_file_of_the_spec_names_the_schema() -> None:
    for path in FILES:
        first = path.read_text().splitlines()[0]
        _, _, name = first.partition("# yaml-language-server: $schema=")
        assert (path.parent / name).resolve() == vectors.ROOT / "spec/schema.json", path
