"""Writes ``edition.json`` as scripts for the docs site's decoder page.

The page also works as a file, which may load scripts but no JSON.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import PurePosixPath

from cobotwire_codegen.model import Edition
from cobotwire_codegen.publish import edition_json
from cobotwire_codegen.render import Files
from cobotwire_codegen.targets.typescript import literal


def render_decoder(editions: Sequence[Edition]) -> Files:
    """Return a script for each edition, and ``editions.js``, which lists the editions."""
    scripts = {PurePosixPath(f"{edition.name}.js"): edition_script(edition) for edition in editions}
    names = json.dumps([edition.name for edition in editions])
    page = f"globalThis.cobotwire = {{ tables: {{}}, editions: {names} }};\n"
    return scripts | {PurePosixPath("editions.js"): page}


def edition_script(edition: Edition) -> str:
    """Return the script that adds the table of an edition, as JSON."""
    return f"cobotwire.tables.{edition.name} = {literal(edition_json(edition))};\n"
