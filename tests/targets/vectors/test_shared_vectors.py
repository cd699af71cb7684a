"""The language-neutral vectors are complete, match their schema, and agree with both codecs."""

from __future__ import annotations

import copy
import json
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import vectors
from cobotwire import codec as codecs
from cobotwire import editions as shipped
from cobotwire_codegen import lower
from cobotwire_codegen.model import Enum, Field, Quantity
from cobotwire_codegen.targets.vectors.document import document
from random_editions import editions
from strategies import CODECS, TABLES, codec_of
from targets.built import built
from targets.expected import codec_of_edition
from targets.specs import SPECS, edition_of
from targets.vectors.comparison import Record, read, sample, validated
from wrong_models import WRONG, with_wrong_angles

EDITIONS = sorted(TABLES)


@pytest.mark.parametrize("name", CODECS)
@pytest.mark.parametrize("edition", EDITIONS)
def test_every_vector_agrees_with_codec(edition: str, name: codecs.CodecName) -> None:
    found = validated(read(edition), codec_of(edition, name))
    assert found.differences == []
    assert found.vectors > 1000
    assert found.fields > 300


@pytest.mark.parametrize("edition", [n for n in vectors.further() if n in vectors.sampled()])
def test_sample_of_vectors_of_further_editions_agrees_with_codecs(edition: str) -> None:
    """`make targets` compares all vectors of all editions, in all targets."""
    for codec in CODECS:
        found = validated(sample(edition, "set_pro_gripper"), codec_of(edition, codec))
        assert found.differences == []
        assert found.refused > 20


@pytest.mark.parametrize("name", sorted(SPECS))
def test_vectors_of_other_types_and_frames_agree_with_codecs(name: str) -> None:
    edition = edition_of(name)
    found = json.loads(document(edition))
    for codec in CODECS:
        assert validated(found, codec_of_edition(edition, codec)).differences == []
    assert list(_validator().iter_errors(found)) == []


def test_vectors_of_floats_and_texts_have_their_ends() -> None:
    found = json.loads(document(edition_of("sensor")))
    fields = [field for record in found["messages"] for field in record["fields"]]
    drifts = {str(field["value"][0]) for field in fields if field["name"] == "drift"}
    assert {"NaN", "Infinity", "-Infinity", "-0.0", "0.0"} <= drifts
    notes = {field["text"] for field in fields if field["name"] == "note"}
    assert {"", "é"} <= {note[:1] for note in notes}
    reasons = {r["reason"] for r in found["malformed"] if "label 128" in r["name"]}
    assert reasons == {"bad-value"}


# Shrinking would take minutes.
@settings(max_examples=15, phases=[Phase.generate], suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_vectors_of_random_protocols_agree_with_codecs(tmp_path: Path, data: st.DataObject) -> None:
    edition = data.draw(editions(tmp_path, "rnd"))
    found = json.loads(document(edition))
    for codec in CODECS:
        assert validated(found, codec_of_edition(edition, codec)).differences == []


def _validator() -> jsonschema.Draft202012Validator:
    schema = json.loads((built("vectors") / "schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


@pytest.mark.parametrize("edition", EDITIONS)
def test_vector_document_matches_its_schema(edition: str) -> None:
    validator = _validator()
    found = read(edition)
    assert list(validator.iter_errors(found)) == []
    broken = copy.deepcopy(found)
    broken["streams"][0]["events"][0]["frame"] = 65536
    assert list(validator.iter_errors(broken))


@pytest.mark.parametrize("name", EDITIONS)
def test_every_variant_choice_and_case_has_a_vector(name: str) -> None:
    edition = vectors.edition(name)
    found = read(name)["messages"]
    variants = Counter((r["command"], r["direction"], r["variant"]) for r in found)
    for command in edition.commands:
        for direction in ("request", "reply"):
            for index, variant in enumerate(command.variants(direction)):
                key = (command.name, direction, index)
                assert variants[key], key
                mine = [r for r in found if (r["command"], r["direction"], r["variant"]) == key]
                for field in variant:
                    _has_all(field, mine, key)


def _has_all(field: Field, records: list[Record], key: Any) -> None:
    numbers = [part for r in records for part in r["fields"] if part["name"] == field.name]
    used = {raw for part in numbers for raw in part["raw"]}
    assert set(lower.field_choices(field)) <= used, (key, field.name)
    if isinstance(field.type, Enum) and field.const is None:
        labels = {part["label"] for part in numbers}
        assert labels == {member.name for member in field.type.members}, (key, field.name)
    for _, type in lower.cases(field):
        if isinstance(type, Quantity) and field.const is None:
            assert {int(bound) for bound in type.bounds} <= used, (key, field.name, type.name)


@pytest.mark.parametrize("edition", EDITIONS)
def test_vectors_contain_every_kind_of_fault_and_event(edition: str) -> None:
    found = read(edition)
    reasons = {record["reason"] for record in found["malformed"]}
    kinds = {"no-header", "bad-length", "unknown-id", "bad-check", "truncated", "bad-value"}
    assert reasons == {*kinds, "trailing"}
    events = [event for stream in found["streams"] for event in stream["events"]]
    assert {event["noise"] for event in events if "noise" in event} == kinds - {"bad-value"}
    texts = {(record["command"], record["direction"]) for record in found["texts"]}
    table = TABLES[edition]
    due = {(c.name, "reply") for c in table.commands if c.text}
    assert texts == due | {(c.name, "request") for c in table.commands if c.request_text}


@pytest.mark.parametrize("kind", WRONG)
def test_vectors_of_a_wrong_model_differ_from_codec(kind: str) -> None:
    wrong = json.loads(document(with_wrong_angles(vectors.edition("mycobot"), WRONG[kind])))
    found = validated(wrong, codec_of("mycobot", "reference")).differences
    assert any("get_angles" in difference for difference in found)
    # A reply of id 20 that neither command allows is reported with the values of the first one.
    assert all("get_angles" in one or "get_radians" in one for one in found)


def test_edition_without_replies_has_vectors() -> None:
    edition = vectors.edition("mycobot")
    silent = [replace(c, replies=(), text=None) for c in edition.commands if not c.text]
    family = replace(edition.families[0], commands=tuple(silent))
    found = json.loads(document(replace(edition, families=(family,))))
    assert {record["direction"] for record in found["messages"]} == {"request"}


def test_vector_folder_holds_the_files_of_the_guide() -> None:
    names = {path.name for path in built("vectors").iterdir()}
    assert names == {"schema.json", *(f"{edition}.json" for edition in shipped.names())}
