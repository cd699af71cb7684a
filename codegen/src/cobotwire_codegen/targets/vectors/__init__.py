"""Vectors for everybody: JSON that any implementation, in any language, can test itself with."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path, PurePosixPath

from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import Files
from cobotwire_codegen.targets.vectors.document import document

_SCHEMA = Path(__file__).with_name("schema.json")


def render_shared_vectors(editions: Sequence[Edition]) -> Files:
    """A file an edition, and the schema of them all."""
    files = {PurePosixPath(f"{edition.name}.json"): document(edition) for edition in editions}
    return files | {PurePosixPath("schema.json"): _SCHEMA.read_text(encoding="utf-8")}
