"""Builds the model from nodes: resolves references and fills in defaults."""

from cobotwire_codegen.build.edition import Built, build_edition

__all__ = ["Built", "build_edition"]
