"""The schema accepts the same keys and words in a file as the checker."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from jsonschema import Draft7Validator

import vectors
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.language.schema import editor_schema, schema_json
from cobotwire_codegen.load import Node, load
from cobotwire_codegen.model import Edition
from cobotwire_codegen.project import SERVO_BUS, edition_files
from codegen.author import samples
from codegen.author.schema_walk import Closed, Walk, Word, plain
from codegen.test_generator import EDITIONS, copy_spec

Found = Closed | Word
# Files of the spec that the schema does not describe: one has types of its own, one is no edition.
OTHERS = {vectors.ROOT / SERVO_BUS, vectors.ROOT / "spec" / "pymycobot.yaml"}


class Corpus(NamedTuple):
    """A folder with editions, and the schema generated from them."""

    root: Path
    editions: tuple[Path, ...]
    walk: Walk

    def files(self) -> list[Path]:
        """Return every file of the editions."""
        found = (path for path in self.root.rglob("*.yaml") if "tests" not in path.parts[-3:])
        return sorted(path for path in found if path not in OTHERS)

    def load(self, path: Path) -> Node:
        """Return the root node of a file; messages name the file relative to the corpus."""
        return load(path, path.relative_to(self.root).as_posix())


def _corpus(root: Path, paths: list[Path], editions: Iterable[Edition]) -> Corpus:
    return Corpus(root, tuple(paths), Walk(editor_schema([*editions])))


@cache
def corpora() -> tuple[Corpus, ...]:
    """Return the project's spec, and the samples, which use the whole language."""
    spec = vectors.ROOT / "spec"
    of_samples = [samples.FOLDER / name for name in samples.EDITIONS]
    return (
        _corpus(spec, edition_files(vectors.ROOT), vectors.editions().values()),
        _corpus(samples.FOLDER, of_samples, (build_edition(p, samples.FOLDER) for p in of_samples)),
    )


def _occurrences() -> dict[str, tuple[int, Path, Found]]:
    """Return the first place where each list of keys and each list of words is used.

    The samples come first: a test changes the place and builds its edition, and theirs are small.
    """
    found: dict[str, tuple[int, Path, Found]] = {}
    for index, corpus in reversed([*enumerate(corpora())]):
        for path in corpus.files():
            root = corpus.load(path)
            items: list[Found] = [*corpus.walk.closed(root), *corpus.walk.words(root)]
            for item in items:
                kind = item.definition if isinstance(item, Closed) else f"word {item.definition}"
                found.setdefault(kind, (index, path, item))
    return found


OCCURRENCES = _occurrences()
CLOSED = sorted(kind for kind in OCCURRENCES if not kind.startswith("word "))
WORDS = sorted(kind for kind in OCCURRENCES if kind.startswith("word "))


def test_schemas_are_valid_json_schemas() -> None:
    for corpus in corpora():
        Draft7Validator.check_schema(corpus.walk.schema)


def test_every_spec_file_is_valid() -> None:
    for corpus in corpora():
        for path in corpus.files():
            errors = list(corpus.walk.validator.iter_errors(plain(corpus.load(path))))
            assert errors == [], path


def test_every_mapping_of_the_schema_occurs_in_the_corpora() -> None:
    definitions = corpora()[0].walk.schema["definitions"]
    closed = {name for name, schema in definitions.items() if "properties" in schema}
    assert closed <= set(CLOSED)


def _mutated(tmp_path: Path, kind: str, change: str) -> tuple[list[str], list[str]]:
    """Change one place; return the schema's errors and the checker's codes."""
    index, path, item = OCCURRENCES[kind]
    corpus = corpora()[index]
    data = plain(corpus.load(path))
    holder: Any = data
    for step in item.path if isinstance(item, Closed) else item.path[:-1]:
        holder = holder[step]
    holder["zz_unknown" if isinstance(item, Closed) else item.path[-1]] = change
    messages = [error.message for error in corpus.walk.validator.iter_errors(data)]
    copy = Path(shutil.copytree(corpus.root, tmp_path / "changed"))
    # JSON is YAML.
    (copy / path.relative_to(corpus.root)).write_text(json.dumps(data, indent=1))
    codes: set[str] = set()
    # Build the file's own edition first: it reports the most problems, and building takes time.
    for edition in sorted(
        corpus.editions, key=lambda e: not path.is_relative_to(e.with_suffix(""))
    ):
        problems = samples.problems(copy / edition.relative_to(corpus.root))
        codes.update(problem.code for problem in problems)
        if codes:
            break
    return messages, sorted(codes)


@pytest.mark.parametrize("kind", CLOSED)
def test_unknown_key_is_rejected_by_schema_and_checker(tmp_path: Path, kind: str) -> None:
    messages, codes = _mutated(tmp_path, kind, "zz")
    assert any("zz_unknown" in message for message in messages), messages
    assert "unknown-key" in codes


@pytest.mark.parametrize("kind", WORDS)
def test_unknown_word_is_rejected_by_schema_and_checker(tmp_path: Path, kind: str) -> None:
    messages, codes = _mutated(tmp_path, kind, "zzz")
    assert any("zzz" in message for message in messages), messages
    assert codes != []


def test_types_of_every_edition_can_be_named() -> None:
    schema = corpora()[0].walk.schema
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
    for path in corpora()[0].files():
        first = path.read_text().splitlines()[0]
        _, _, name = first.partition("# yaml-language-server: $schema=")
        assert (path.parent / name).resolve() == vectors.ROOT / "spec/schema.json", path
