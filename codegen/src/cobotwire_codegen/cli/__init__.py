"""The command ``cobotwire-gen``, with one module for each subcommand."""

from cobotwire_codegen.cli.app import main

__all__ = ["main"]
