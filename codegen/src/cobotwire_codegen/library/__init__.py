"""Generates the layer with the maker's method names, from ``spec/pymycobot.yaml``."""

from cobotwire_codegen.library.build import build_library
from cobotwire_codegen.library.model import Library
from cobotwire_codegen.library.render import render_library, render_page

__all__ = ["Library", "build_library", "render_library", "render_page"]
