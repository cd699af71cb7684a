"""The spec agrees with the protocol document: its examples, its lines, its mistakes."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

import vectors
from cobotwire_codegen.model import Quantity

SHARED = vectors.ROOT.parent / "shared" / "protocol"
needs_shared = pytest.mark.skipif(
    not SHARED.is_dir(), reason="the protocol document is not part of the repository"
)


def _examples() -> list[dict[str, Any]]:
    return [json.loads(line) for line in (SHARED / "examples.jsonl").read_text().splitlines()]


def _document(path: Path = SHARED / "document.txt") -> list[str]:
    return path.read_text().splitlines()


def test_edition_mycobot_has_64_commands_with_unique_ids() -> None:
    ids = [command.id for command in vectors.edition().commands]
    assert len(ids) == len(set(ids)) == 64


def test_every_inconsistent_example_has_an_erratum() -> None:
    edition = vectors.edition()
    odd = {v.example for v in edition.vectors if v.example and v.verdict != "consistent"}
    assert len(odd) == 25
    assert odd <= {erratum.example for erratum in edition.errata}


def test_every_dispute_has_evidence() -> None:
    edition = vectors.edition()
    disputed = {command.name for command in edition.commands if command.disputed}
    assert {"set_joint_min", "set_joint_max", "send_coord"} <= disputed
    quantities = [type for type in edition.types if isinstance(type, Quantity)]
    assert any(quantity.disputed for quantity in quantities)
    for command in edition.commands:
        for dispute in command.disputed:
            assert len(dispute.evidence) >= 2, f"{command.name}: a dispute has two sides"


@needs_shared
def test_vectors_contain_all_examples_of_the_document() -> None:
    ours = [vector for vector in vectors.edition().vectors if vector.example]
    for vector, example in zip(ours, _examples(), strict=True):
        frame = example["frame"]
        assert vector.line == example["line"]
        assert vector.direction == example["direction"]
        assert vector.verdict == example["verdict"]
        assert vector.printed == bytes.fromhex(example["printed"])
        assert vector.frame == (None if frame is None else bytes.fromhex(frame))


@needs_shared
def test_printed_frames_match_their_lines_of_the_document() -> None:
    document = _document()
    for vector in vectors.edition().vectors:
        if vector.example:
            assert vector.line is not None
            assert vector.printed is not None
            printed = re.sub(r"\s", "", document[vector.line - 1]).lower()
            assert vector.printed.hex() in printed


@needs_shared
def test_errata_quote_their_lines_of_the_document() -> None:
    document = _document()
    for erratum in vectors.edition().errata:
        text = " ".join(" ".join(document[first - 1 : last]) for first, last in erratum.lines)
        for quoted in erratum.says.split(" / "):
            words = re.sub(r"\s+", " ", quoted).strip()
            assert words in re.sub(r"\s+", " ", text), f"{erratum.place}: {quoted!r}"
