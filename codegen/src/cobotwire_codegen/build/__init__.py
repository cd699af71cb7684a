"""Builds the model from nodes: resolves references and fills in defaults."""

from cobotwire_codegen.build.edition import build_edition, build_editions

__all__ = ["build_edition", "build_editions"]
