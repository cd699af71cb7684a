"""``edition.json`` and ``cobotwire-gen model`` publish an edition in one format."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from fractions import Fraction
from typing import Any

import pytest

import vectors
from cobotwire import editions
from cobotwire_codegen.errors import Place
from cobotwire_codegen.publish import edition_json

EDITIONS = ("mycobot", "mycobot280")
# edition.json states the file and line of commands and types, not of fields, members and texts.
WITHOUT_PLACE = ("Field", "Member", "Text", "ReadBack", "Effect")


def leaves(value: Any) -> Iterator[str]:
    """Yield every text of the model, and every place, as edition.json writes them."""
    if isinstance(value, Place):
        yield str(value)
    elif isinstance(value, tuple):
        for part in value:
            yield from leaves(part)
    elif is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            # Skip where the delta removes a command: the change itself states the same place.
            if field.name == "gone":
                continue
            if field.name != "place" or type(value).__name__ not in WITHOUT_PLACE:
                yield from leaves(getattr(value, field.name))
    elif isinstance(value, str):
        yield value
    elif isinstance(value, Fraction) and value.denominator != 1:
        yield str(value)


def texts(value: Any) -> Iterator[str]:
    """Yield every string of a JSON document, also the keys, because effects are stated as keys."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield key
            yield from texts(part)
    elif isinstance(value, list):
        for part in value:
            yield from texts(part)
    elif isinstance(value, str):
        yield value


@pytest.mark.parametrize("name", EDITIONS)
def test_complete_document_holds_every_text_of_the_model(name: str) -> None:
    edition = vectors.edition(name)
    published = set(texts(json.loads(edition_json(edition, complete=True))))
    # edition.json has ranges as raw bounds; the codec tests compare these with the model.
    ranges = {str(part) for t in edition.types for part in getattr(t, "range", None) or ()}
    # The usual layout and encoding are left out.
    usual = {*edition.frame.layout, *edition.frame.counted} if edition.frame.usual else set()
    usual |= {"integer"}  # the encoding of every wire type that is not a float
    missing = set(leaves(edition)) - ranges - published - usual
    # In edition.json a selector value that has no name is an integer, not a string.
    assert not {text for text in missing if text and not text.isdigit()}


@pytest.mark.parametrize("name", EDITIONS)
def test_committed_document_is_the_complete_one_without_the_sections_for_people(name: str) -> None:
    edition = vectors.edition(name)
    complete = json.loads(edition_json(edition, complete=True))
    short = json.loads(edition_json(edition))
    assert complete.keys() - short.keys() == {"sources", "changes", "errata", "vectors"}
    assert {key: complete[key] for key in short} == short


@pytest.mark.parametrize("name", EDITIONS)
def test_package_of_another_version_is_rejected(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    from cobotwire.protocol import loading

    package = editions.load(name)
    monkeypatch.setattr(loading, "VERSION", 99)
    with pytest.raises(ValueError, match="has version 3 of the format, not 99; generate"):
        loading.load_table(package.__name__, None)  # type: ignore[attr-defined]
