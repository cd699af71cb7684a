"""The description of the language is complete, and its examples and its page are correct."""

from __future__ import annotations

import re
from collections import defaultdict
from typing import Any

import pytest
from jsonschema import Draft7Validator

import vectors
from cobotwire_codegen import language
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.errors import Problem
from cobotwire_codegen.language.edition import FILES
from cobotwire_codegen.language.records import Choice, Key, Record
from cobotwire_codegen.language.reference import language_page
from cobotwire_codegen.language.schema import editor_schema, records
from cobotwire_codegen.load import Node, parse
from cobotwire_codegen.project import edition_files
from cobotwire_codegen.reader import Reader
from codegen.author import samples
from codegen.author.schema_walk import plain

RECORDS = [one for one in records(FILES.values()) if not isinstance(one, Choice)]
WITH_EXAMPLE = [record for record in RECORDS if record.EXAMPLE]


def _name(record: type[Record]) -> str:
    return record.definition()


def test_builders_read_every_key_of_every_record(monkeypatch: pytest.MonkeyPatch) -> None:
    read: dict[type[Record], set[str]] = defaultdict(set)
    inner = Reader.node

    def node(self: Reader, key: Key[Any]) -> Node | None:
        read[self.record].add(key.name)
        return inner(self, key)

    monkeypatch.setattr(Reader, "node", node)
    for path in edition_files(vectors.ROOT):
        build_edition(path, vectors.ROOT)
    for name in samples.EDITIONS:
        build_edition(samples.FOLDER / name, samples.FOLDER)
    for record in RECORDS:
        assert read[record] == set(record.keys()), record.definition()


def test_reading_a_key_that_the_record_does_not_describe_fails() -> None:
    reader = Reader(parse("errata: []", "a.yaml"), language.ErrataFile, "the errata file", [])
    with pytest.raises(AssertionError, match="ErrataFile describes no vectors"):
        reader.get(language.VectorsFile.vectors)


@pytest.mark.parametrize("record", WITH_EXAMPLE, ids=_name)
def test_example_of_a_record_is_valid_by_schema_and_reader(record: type[Record]) -> None:
    node = parse(record.EXAMPLE, "example.yaml")
    schema = editor_schema([])
    rule = {"$ref": f"#/definitions/{record.definition()}", "definitions": schema["definitions"]}
    assert [error.message for error in Draft7Validator(rule).iter_errors(plain(node))] == []
    problems: list[Problem] = []
    reader = Reader(node, record, "the example", problems)
    for key in record.keys().values():
        reader.get(key)
    assert problems == []


@pytest.mark.parametrize("record", RECORDS, ids=_name)
def test_page_describes_every_record_and_key(record: type[Record]) -> None:
    _, _, after = language_page().partition(f"\n### {record.heading()}\n")
    section = re.split(r"\n##", after)[0]
    assert record.description() in section
    for name, key in record.keys().items():
        assert f"| `{name}`" in section
        assert key.doc in section


def test_each_link_of_the_page_leads_to_one_of_its_headings() -> None:
    page = language_page()
    headings = {
        line.lstrip("# ").lower().replace(" ", "-")
        for line in page.splitlines()
        if line.startswith("#")
    }
    links = set(re.findall(r"\]\(#([^)]*)\)", page))
    assert links
    assert links <= headings
