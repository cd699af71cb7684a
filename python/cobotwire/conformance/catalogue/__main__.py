"""``python -m cobotwire.conformance.catalogue``: print the pages as JSON, for cobotwire-gen."""

from __future__ import annotations

import json
import sys

from cobotwire.conformance.catalogue.listing import outdated
from cobotwire.conformance.catalogue.pages import pages


def main() -> None:
    """Print a JSON object, the text of each file by its name; exit with 1 if outdated."""
    if message := outdated():
        sys.exit(message)
    json.dump(pages(), sys.stdout)


main()
