"""``python -m cobotwire.conformance.catalogue``: print the pages as JSON, for cobotwire-gen."""

from __future__ import annotations

import json
import sys

from cobotwire.conformance.catalogue.listing import outdated
from cobotwire.conformance.catalogue.pages import pages


def main() -> None:
    """Print an object of texts by file name; exit with 1 if the catalogue needs a new version."""
    if message := outdated():
        sys.exit(message)
    json.dump(pages(), sys.stdout)


main()
