"""Wireshark shows every field of every vector with the value that the Python codec returns."""

from __future__ import annotations

from pathlib import Path

import pytest

import vectors
from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.targets.wireshark import render_wireshark
from strategies import TABLES, codec_of
from targets.wireshark.captures import Chunk, serial
from targets.wireshark.comparison import compare, compared, lines_of
from targets.wireshark.dissecting import needs_tshark, tshark
from wrong_models import WRONG, with_wrong_angles

pytestmark = needs_tshark
EDITIONS = sorted(TABLES)


@pytest.mark.parametrize("edition", EDITIONS)
def test_every_field_of_every_vector_agrees_with_codec(edition: str) -> None:
    found = compare(edition)
    assert found.differences == []
    assert found.vectors > 1000
    assert found.fields > 700


@pytest.mark.parametrize("fault", sorted(WRONG))
def test_fields_of_a_wrong_model_differ_from_codec(fault: str, tmp_path: Path) -> None:
    wrong = with_wrong_angles(vectors.edition(), WRONG[fault])
    write(Target(tmp_path, render_wireshark([wrong])))
    lines = [line for line in lines_of("mycobot") if "angles re" in line.name]
    found = compared(lines, codec_of("mycobot", "reference"), [tmp_path / "mycobot.lua"])
    assert found.differences
    # The wrong field is reported, and nothing else.
    assert {text.split(" reply")[0] for text in found.differences} == {"messages: get_angles"}


def test_filters_find_values_by_field_and_by_label(tmp_path: Path) -> None:
    def found(query: str) -> list[str]:
        return tshark(path, "-Y", query, "-T", "fields", "-e", "frame.number").split()

    codec = codec_of("mycobot280", "reference")
    sent = [("send_angle", (1, 90.5, 20)), ("send_angle", (2, -90.5, 20)), ("get_angles", ())]
    path = tmp_path / "line.pcapng"
    chunks = [Chunk(0, "request", codec.encode(name, "request", values)) for name, values in sent]
    path.write_bytes(serial([*chunks, Chunk(0, "reply", b"Guru Meditation")], "mycobot280"))
    assert found("mycobot280.angle > 90") == ["1"]
    assert found("mycobot280.angle < 0 && mycobot280.joint == 2") == ["2"]
    assert found('mycobot280.frame.command == "get_angles"') == ["3"]
    assert found('mycobot280.noise.no_header && mycobot280.noise.text contains "Guru"') == ["4"]
