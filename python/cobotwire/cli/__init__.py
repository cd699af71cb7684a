"""Run the command ``cobotwire``; it needs the packages of the extra ``cli``."""

from __future__ import annotations

import sys


def main() -> None:
    """Run the command line."""
    try:
        import click  # noqa: F401  (imported only to see whether it is installed)
        import rich  # noqa: F401
    except ImportError as error:
        sys.exit(f"cobotwire: {error}. The command line needs: pip install 'cobotwire[cli]'")
    from cobotwire.cli.app import app

    app(prog_name="cobotwire")
