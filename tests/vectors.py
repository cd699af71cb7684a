"""The spec's model and its vectors, as the generator reads them."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

from cobotwire_codegen.model import Edition, Vector
from cobotwire_codegen.project import editions
from cobotwire_codegen.render.vectors_json import plain

ROOT = Path(__file__).parent.parent


@lru_cache(maxsize=1)
def edition() -> Edition:
    """The edition ``mycobot``, checked."""
    return next(edition for edition in editions(ROOT) if edition.name == "mycobot")


def framed() -> list[Vector]:
    """The vectors that are frames."""
    return [vector for vector in edition().vectors if vector.frame is not None]


def refused() -> list[Vector]:
    """The vectors whose printed bytes are no legal frame."""
    return [vector for vector in edition().vectors if vector.refused is not None]


def values(vector: Vector) -> tuple[Any, ...]:
    """A vector's values as the codecs give them."""
    found = (plain(edition(), vector, name, value) for name, value in vector.values)
    return tuple(tuple(value) if isinstance(value, list) else value for value in found)
