"""Dissectors of other protocols, with every type and in random frames, agree with the codec."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import vectors
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Listening
from cobotwire.protocol.loading import table_of
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.model import Edition
from cobotwire_codegen.publish import edition_json
from cobotwire_codegen.targets.wireshark import render_wireshark
from targets.built import built
from targets.wireshark.comparison import Line, all_compared
from targets.wireshark.dissecting import needs_tshark

pytestmark = needs_tshark
TESTS = vectors.ROOT / "tests"
SPECS = [
    *(TESTS / "codegen" / "families" / f"{name}.yaml" for name in ("sensor", "mercury", "mybuddy")),
    *(TESTS / "protocols" / f"{name}.yaml" for name in ("feetech", "dynamixel", "ublox")),
]


def codec_of(edition: Edition) -> Codec:
    return codecs.load(table_of(json.loads(edition_json(edition))), "reference")


def lines_of(edition: Edition) -> Iterator[Line]:
    """Return lines with each vector, whole, damaged and in pieces, and with all of a direction."""
    ways: list[Listening] = ["request", "reply"]
    for vector in edition.vectors:
        if frame := vector.frame:
            broken = frame[:-1] + bytes([frame[-1] ^ 1])
            pieces = [frame[at : at + 5] for at in range(0, len(frame), 5)]
            yield Line(vector.name, vector.direction, [frame])
            yield Line(f"{vector.name}, damaged, whole", vector.direction, [broken + frame])
            yield Line(f"{vector.name}, in pieces", "both", pieces)
    for way in ways:
        frames = [each.frame for each in edition.vectors if each.frame and each.direction == way]
        yield Line(f"every {way} with noise between", way, [frame + b"\xff" for frame in frames])


def compare(editions: list[Edition], folder: Path) -> None:
    """Check that the dissectors in a folder show what the codecs read."""
    parts = [(list(lines_of(edition)), codec_of(edition)) for edition in editions]
    found = all_compared(parts, [folder / f"{edition.name}.lua" for edition in editions])
    assert found.fields > 100
    assert found.differences == [], "\n".join(found.differences)


def test_other_protocols_are_dissected(tmp_path: Path) -> None:
    editions = [build_edition(path, path.parent) for path in SPECS]
    write(Target(tmp_path / "lua", render_wireshark(editions)))
    compare(editions, tmp_path / "lua")


def test_shipped_editions_are_dissected() -> None:
    """Read a part of the vectors; the two editions with the most commands have other tests."""
    editions = [vectors.edition(name) for name in vectors.further()]
    assert len(editions) > 5
    few = [replace(each, vectors=each.vectors[::8]) for each in editions]
    compare(few, built("wireshark"))
