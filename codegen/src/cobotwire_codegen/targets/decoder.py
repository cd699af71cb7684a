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

# JavaScript reads integers of at most this many characters exactly.
_EXACT = 15


def render_decoder(editions: Sequence[Edition]) -> Files:
    """Return a script for each edition, and ``editions.js``, which lists the editions."""
    scripts = {PurePosixPath(f"{edition.name}.js"): edition_script(edition) for edition in editions}
    names = json.dumps([edition.name for edition in editions])
    return scripts | {PurePosixPath("editions.js"): f"cobotwire.editions = {names};\n"}


def edition_script(edition: Edition) -> str:
    """Return the script that adds an edition; large integers become texts."""
    document = json.loads(edition_json(edition), parse_int=_exact)
    return f"cobotwire.add({json.dumps(document)});\n"


def _exact(digits: str) -> int | str:
    return int(digits) if len(digits) <= _EXACT else digits
