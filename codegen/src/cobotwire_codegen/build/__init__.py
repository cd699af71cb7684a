"""Nodes to the model: references resolved, defaults filled in."""

from cobotwire_codegen.build.edition import build_edition

__all__ = ["build_edition"]
