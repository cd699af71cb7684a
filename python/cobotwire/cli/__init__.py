"""Run the command ``cobotwire``."""

from __future__ import annotations

import sys


def main() -> None:
    """Run the command line."""
    try:
        import click  # noqa: F401  (imported only to see whether it is installed)
        import rich  # noqa: F401
    except ImportError:
        # They are dependencies of cobotwire; pip install --no-deps leaves them out.
        sys.exit("cobotwire: the command line needs click and rich: pip install click rich")
    from cobotwire.cli.app import app

    app(prog_name="cobotwire")
