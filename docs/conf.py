"""Configure the docs site (``make docs``): warnings are errors, and nothing is fetched."""

from __future__ import annotations

from fnmatch import fnmatch
from importlib.metadata import version as version_of
from typing import Any

from sphinx.application import Sphinx

project = "cobotwire"
author = "the cobotwire engineers"
copyright = "the cobotwire engineers"
version = release = version_of("cobotwire")

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
]
# Quotes and dashes are meant as they are written: two dashes begin an option.
smartquotes = False
source_suffix = {".md": "markdown"}
exclude_patterns = ["_build"]
nitpicky = False
# A block that names no language is program output, or commands.
highlight_language = "none"

myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence", "deflist"]

autodoc_typehints = "description"
autodoc_member_order = "bysource"
autodoc_class_signature = "separated"
napoleon_google_docstring = True
napoleon_numpy_docstring = False
# Otherwise Sphinx describes the fields of a named tuple twice.
napoleon_use_ivar = True

html_theme = "furo"
html_title = "cobotwire"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_theme_options = {"source_directory": "docs/"}
html_show_sphinx = False
# Each page links to its source in the repository.
html_copy_source = False


def _add_pages(app: Sphinx, page: str, source: list[str]) -> None:
    """List below the front page of each edition the other pages of its folder."""
    if fnmatch(page, "reference/*/README"):
        source[0] += "\n```{toctree}\n:hidden:\n:glob:\n\n*\n```\n"


def _collapse(app: Sphinx, page: str, template: str, context: dict[str, Any], tree: object) -> None:
    """Show the pages of an edition only to readers of that edition.

    Otherwise each page has 200 links to them, and they take a third of the time of the build.
    """
    whole = context.get("toctree")
    if whole is not None:
        context["toctree"] = lambda **options: whole(**{**options, "collapse": True})


def setup(app: Sphinx) -> None:
    """Change the navigation before the theme (priority 500) writes it."""
    app.connect("source-read", _add_pages)
    app.connect("html-page-context", _collapse, priority=400)
