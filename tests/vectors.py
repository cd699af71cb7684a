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
def _editions() -> dict[str, Edition]:
    return {edition.name: edition for edition in editions(ROOT)}


def edition(name: str = "mycobot") -> Edition:
    """An edition, checked; left out: ``mycobot``."""
    return _editions()[name]


def every() -> list[tuple[str, Vector]]:
    """The vectors of all editions, each with its edition's name."""
    return [(name, vector) for name, found in _editions().items() for vector in found.vectors]


def framed() -> list[tuple[str, Vector]]:
    """The vectors that are frames."""
    return [(name, vector) for name, vector in every() if vector.frame is not None]


def refused() -> list[tuple[str, Vector]]:
    """The vectors whose printed bytes are no legal frame."""
    return [(name, vector) for name, vector in every() if vector.refused is not None]


def fields(name: str, vector: Vector) -> dict[str, Any]:
    """A vector's values by name, as the codecs give them."""
    found = {key: plain(edition(name), vector, key, value) for key, value in vector.values}
    return {key: tuple(v) if isinstance(v, list) else v for key, v in found.items()}
