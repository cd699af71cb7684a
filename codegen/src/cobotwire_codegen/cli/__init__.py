"""The command ``cobotwire-gen``, with one module for each verb."""

from cobotwire_codegen.cli.app import main

__all__ = ["main"]
