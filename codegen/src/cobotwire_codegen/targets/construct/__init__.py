"""Writes declarations for construct, an independent parsing library."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePosixPath

from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import Files, environment
from cobotwire_codegen.render.literal import literal
from cobotwire_codegen.targets.construct.declarations import Declarations
from cobotwire_codegen.targets.support import require_plain


def render_construct(editions: Sequence[Edition]) -> Files:
    """Return a module for each edition.

    Raises:
        ValueError: an edition's frames have a checksum or an address, which are not declared.
    """
    return {PurePosixPath(f"{edition.name}.py"): _module(edition) for edition in editions}


def _module(edition: Edition) -> str:
    require_plain(edition, "construct")
    template = environment().get_template("construct/edition.py.j2")
    found = Declarations(edition)
    # Messages come first: only they add the types that they need.
    messages = [(literal(key), message) for key, message in found.messages()]
    marks = {"HEADER": edition.frame.header, "FOOTER": edition.frame.footer}
    return template.render(
        edition=edition,
        marks={name: data.hex() for name, data in marks.items()},
        types=found.types,
        messages=messages,
    )
