"""The construct library, an independent oracle, agrees with our codecs and the vectors."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest
from construct import ConstructError
from hypothesis import given
from hypothesis import strategies as st

import vectors
from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import ProtocolError
from cobotwire_codegen.targets.construct import render_construct
from strategies import TABLES, CommandVariant, codec_of, legal_values, variants_of
from targets.construct.comparison import compare, frame_built, messages, numbers
from wrong_models import WRONG, with_wrong_angles

EDITIONS = sorted(TABLES)


@pytest.mark.parametrize("edition", EDITIONS)
def test_construct_parses_and_builds_every_vector(edition: str) -> None:
    found = compare(edition)
    assert found.differences == []
    assert found.vectors > 900


@pytest.mark.parametrize("edition", EDITIONS)
def test_declarations_are_exactly_the_variants(edition: str) -> None:
    right = {
        (variant.command.name, variant.direction, variant.number)
        for variant in variants_of(TABLES[edition])
    }
    assert set(messages(edition)) == right


@pytest.mark.parametrize("edition", EDITIONS)
@given(data=st.data())
def test_random_messages_agree_with_codec(edition: str, data: st.DataObject) -> None:
    variant = data.draw(st.sampled_from(variants_of(TABLES[edition])))
    values = data.draw(legal_values(variant.variant))
    codec = codec_of(edition, "native")
    frame = codec.encode(variant.command.name, variant.direction, values, variant=variant.number)
    declaration = messages(edition)[variant.command.name, variant.direction, variant.number]
    parsed = declaration.parse(frame)
    lists = [list(value) if isinstance(value, tuple) else [value] for value in values]
    right = dict(zip((field.name for field in variant.variant.fields), lists))
    assert {name: numbers(parsed[name]) for name in right} == right
    assert frame_built(declaration, right) == frame


@pytest.mark.parametrize("edition", EDITIONS)
@given(data=st.data())
def test_any_data_is_accepted_by_both_or_neither(edition: str, data: st.DataObject) -> None:
    variant = data.draw(st.sampled_from(variants_of(TABLES[edition])))
    frame = data.draw(st.binary(min_size=variant.variant.size, max_size=variant.variant.size))
    table = TABLES[edition].frame
    whole = bytes([table.length(variant.variant.size), variant.command.id]) + frame
    whole = table.header + whole + table.footer
    assert _taken(edition, variant, whole) == _reads(codec_of(edition, "reference"), variant, whole)


def _taken(edition: str, variant: CommandVariant, frame: bytes) -> bool:
    """Return whether construct accepts the frame as a variant of that size of the command."""
    sizes = {
        other.number
        for other in variants_of(TABLES[edition])
        if other[:2] == variant[:2] and other.variant.size == variant.variant.size
    }
    return any(_parses(edition, (variant.command.name, variant.direction, n), frame) for n in sizes)


def _parses(edition: str, key: tuple[str, str, int], frame: bytes) -> bool:
    try:
        messages(edition)[key].parse(frame)
    except ConstructError:
        return False
    return True


def _reads(codec: Codec, variant: CommandVariant, frame: bytes) -> bool:
    try:
        codec.decode(variant.direction, frame, of=variant.command.name)
    except ProtocolError:
        return False
    return True


@pytest.mark.parametrize("kind", WRONG)
@pytest.mark.parametrize("name", EDITIONS)
def test_declarations_of_a_wrong_model_differ_from_the_vectors(
    name: str, kind: str, tmp_path: Path
) -> None:
    wrong = with_wrong_angles(vectors.edition(name), WRONG[kind])
    for path, text in render_construct([wrong]).items():
        (tmp_path / path).write_text(text)
    declared = runpy.run_path(str(tmp_path / f"{name}.py"))["MESSAGES"]
    found = compare(name, declared).differences
    assert found
    assert all("get_angles" in difference for difference in found)
