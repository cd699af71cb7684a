"""An oracle that nobody here wrote: construct reads what the generated declarations say."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest
from construct import ConstructError
from hypothesis import given
from hypothesis import strategies as st

import vectors
from cobotwire.codec.interface import Codec
from cobotwire.errors import ProtocolError
from cobotwire_codegen.targets.construct import render_construct
from strategies import TABLES, Form, codec_of, forms_of, legal_values
from targets.construct.comparison import built, compare, messages, numbers
from wrong_models import WRONG, with_wrong_angles

EDITIONS = sorted(TABLES)


@pytest.mark.parametrize("edition", EDITIONS)
def test_construct_reads_and_builds_every_vector(edition: str) -> None:
    found = compare(edition)
    assert found.differences == []
    assert found.vectors > 900


@pytest.mark.parametrize("edition", EDITIONS)
def test_every_form_is_declared_and_no_other(edition: str) -> None:
    right = {(form.command.name, form.direction, form.number) for form in forms_of(TABLES[edition])}
    assert set(messages(edition)) == right


@pytest.mark.parametrize("edition", EDITIONS)
@given(data=st.data())
def test_random_messages_read_and_build_alike(edition: str, data: st.DataObject) -> None:
    form = data.draw(st.sampled_from(forms_of(TABLES[edition])))
    values = data.draw(legal_values(form.layout))
    codec = codec_of(edition, "native")
    frame = codec.encode(form.command.name, form.direction, values, form=form.number)
    declaration = messages(edition)[form.command.name, form.direction, form.number]
    parsed = declaration.parse(frame)
    lists = [list(value) if isinstance(value, tuple) else [value] for value in values]
    right = dict(zip((field.name for field in form.layout.fields), lists))
    assert {name: numbers(parsed[name]) for name in right} == right
    assert built(declaration, right) == frame


@pytest.mark.parametrize("edition", EDITIONS)
@given(data=st.data())
def test_any_data_is_taken_by_both_or_by_neither(edition: str, data: st.DataObject) -> None:
    form = data.draw(st.sampled_from(forms_of(TABLES[edition])))
    frame = data.draw(st.binary(min_size=form.layout.size, max_size=form.layout.size))
    table = TABLES[edition].frame
    whole = bytes([table.length(form.layout.size), form.command.id]) + frame
    whole = table.header + whole + table.footer
    assert _taken(edition, form, whole) == _reads(codec_of(edition, "reference"), form, whole)


def _taken(edition: str, form: Form, frame: bytes) -> bool:
    """Whether construct takes it as a form of that size of the command."""
    sizes = {
        other.number
        for other in forms_of(TABLES[edition])
        if other[:2] == form[:2] and other.layout.size == form.layout.size
    }
    return any(_parses(edition, (form.command.name, form.direction, n), frame) for n in sizes)


def _parses(edition: str, key: tuple[str, str, int], frame: bytes) -> bool:
    try:
        messages(edition)[key].parse(frame)
    except ConstructError:
        return False
    return True


def _reads(codec: Codec, form: Form, frame: bytes) -> bool:
    try:
        codec.decode(form.direction, frame, of=form.command.name)
    except ProtocolError:
        return False
    return True


@pytest.mark.parametrize("kind", WRONG)
@pytest.mark.parametrize("name", EDITIONS)
def test_a_wrong_model_shows(name: str, kind: str, tmp_path: Path) -> None:
    wrong = with_wrong_angles(vectors.edition(name), WRONG[kind])
    for path, text in render_construct([wrong]).items():
        (tmp_path / path).write_text(text)
    declared = runpy.run_path(str(tmp_path / f"{name}.py"))["MESSAGES"]
    found = compare(name, declared).differences
    assert found
    assert all("get_angles" in difference for difference in found)
