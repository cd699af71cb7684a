"""The table that Rust reads from an ``edition.json`` is that of Python: their codecs are alike."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import vectors
from cobotwire import codec as codecs
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.protocol.loading import table_of
from cobotwire_codegen.publish import edition_json
from cobotwire_codegen.targets.vectors.document import document
from command_line import run_program
from probe import Probe, needed, path
from random_editions import editions
from strategies import codec_of
from targets.vectors.comparison import read
from vectors import ROOT

Record = dict[str, Any]

pytestmark = needed
EVERY = "EVERY_EDITION" in os.environ


# Its questions take six seconds; `make every-edition` asks those of all.
FEW = [name for name in vectors.sampled() if name == "mycobot" or EVERY]


@pytest.mark.parametrize("name", FEW)
def test_codec_in_rust_passes_every_question(name: str) -> None:
    file = ROOT / "python" / "cobotwire" / "editions" / name / "edition.json"
    done = run_program("--edition", name, "conform", "codec", "--", path(), "codec", file)
    assert done.returncode == 0, done.stdout
    assert "pass" in done.stdout.splitlines()[-1]
    assert "not supported" not in done.stdout


# Each document makes thousands of questions; `make every-edition` asks those of all.
@pytest.mark.parametrize("name", vectors.sampled() if EVERY else FEW)
def test_vectors_of_an_edition_have_the_answers_that_python_gives(name: str) -> None:
    rust = Probe("codec", str(ROOT / "python" / "cobotwire" / "editions" / name / "edition.json"))
    python = OurCodec(codec_of(name, "native"))
    asked = [*_questions(read(name), python)]
    assert len(asked) > 1500
    wrong = [each for each in asked if _compared(rust.ask(each)) != _compared(python.ask(each))]
    assert wrong == []
    rust.close()


# Shrinking would take minutes.
@settings(max_examples=8, phases=[Phase.generate], suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_tables_of_random_editions_are_alike(tmp_path: Path, data: st.DataObject) -> None:
    edition = data.draw(editions(tmp_path, "rnd"))
    file = tmp_path / "edition.json"
    file.write_text(edition_json(edition), encoding="utf-8")
    python = OurCodec(codecs.load(table_of(json.loads(file.read_text("utf-8"))), "native"))
    rust = Probe("codec", str(file))
    for question in _questions(json.loads(document(edition)), python):
        assert _compared(rust.ask(question)) == _compared(python.ask(question)), question
    rust.close()


def _questions(found: Record, python: OurCodec) -> Iterator[Record]:
    """Yield a question for each vector: decode it, and encode what Python decodes."""
    for record in found["messages"] + found["malformed"]:
        data = record["bytes"].replace(" ", "")
        decode = {"do": "decode", "direction": record["direction"], "bytes": data}
        yield decode
        if "command" in record:
            named = {**decode, "command": record["command"]}
            yield named
            fields = python.ask(named)["fields"]
            yield {**named, "do": "encode", "fields": fields}
            yield {**named, "do": "encode", "fields": {n: -1 for n in fields}}
    for record in found["streams"]:
        chunks = [record["bytes"].replace(" ", ""), None]
        yield {"do": "stream", "direction": record["direction"], "chunks": chunks}


def _compared(answer: Record) -> Record:
    """Return an answer without the words of an error."""
    return {key: value for key, value in answer.items() if key not in ("id", "why")}
