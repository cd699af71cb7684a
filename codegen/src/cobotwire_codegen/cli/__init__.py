"""The command ``cobotwire-gen``: one file a verb."""

from cobotwire_codegen.cli.app import main

__all__ = ["main"]
