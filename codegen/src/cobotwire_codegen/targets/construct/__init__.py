"""Declarations for construct, a parsing library that nobody here wrote."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePosixPath

from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import Files, environment
from cobotwire_codegen.render.literal import literal
from cobotwire_codegen.targets.construct.declarations import Declarations


def render_construct(editions: Sequence[Edition]) -> Files:
    """A module an edition.

    Raises:
        ValueError: its frames do not end with a fixed footer; construct is not told of sums.
    """
    return {PurePosixPath(f"{edition.name}.py"): _module(edition) for edition in editions}


def _module(edition: Edition) -> str:
    template = environment().get_template("construct/edition.py.j2")
    found = Declarations(edition)
    # The messages first: they name the types that they need.
    messages = [(literal(key), message) for key, message in found.messages()]
    marks = {"HEADER": edition.frame.header, "FOOTER": edition.frame.footer}
    return template.render(
        edition=edition,
        marks={name: data.hex() for name, data in marks.items()},
        types=found.types,
        messages=messages,
    )
