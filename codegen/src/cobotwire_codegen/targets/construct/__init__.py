"""Writes declarations for construct, an independent parsing library."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path, PurePosixPath

from jinja2 import Template

from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import Files, environment
from cobotwire_codegen.render.literal import literal
from cobotwire_codegen.targets.construct.declarations import Declarations
from cobotwire_codegen.targets.construct.frame import frame_parts


def render_construct(editions: Sequence[Edition], templates: Path | None = None) -> Files:
    """Return a module for each edition; ``templates`` replace the shipped ones.

    Raises:
        SpecError: a field of the type that goes to the end comes before the count of another one.
    """
    template = environment(templates).get_template("construct/edition.py.j2")
    return {PurePosixPath(f"{each.name}.py"): _module(template, each) for each in editions}


def _module(template: Template, edition: Edition) -> str:
    found = Declarations(edition)
    # Messages come first: only they add the types that they need.
    messages = [(literal(key), message) for key, message in found.messages()]
    return template.render(
        edition=edition,
        frame=frame_parts(edition.frame),
        types=found.types.declared,
        messages=messages,
    )
