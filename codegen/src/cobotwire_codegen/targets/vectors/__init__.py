"""Writes vectors as JSON, for tests of implementations in any language."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path, PurePosixPath

from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import Files
from cobotwire_codegen.targets.vectors.document import document

_SCHEMA = Path(__file__).with_name("schema.json")


def render_shared_vectors(editions: Sequence[Edition]) -> Files:
    """Return a file for each edition, and the schema of all."""
    files = {PurePosixPath(f"{edition.name}.json"): document(edition) for edition in editions}
    return files | {PurePosixPath("schema.json"): _SCHEMA.read_text(encoding="utf-8")}
