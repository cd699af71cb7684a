"""The command ``cobotwire``. Importing this needs nothing; running it needs the extra ``cli``."""

from __future__ import annotations

import sys


def main() -> None:
    """Run the command line."""
    try:
        import click  # noqa: F401  (asking whether it is there is the point)
        import rich  # noqa: F401
    except ImportError as error:
        sys.exit(f"cobotwire: {error}. The command line needs: pip install 'cobotwire[cli]'")
    from cobotwire.cli.app import app

    app(prog_name="cobotwire")
