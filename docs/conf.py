"""Configure the docs site (``make docs``): warnings are errors, and nothing is fetched."""

from __future__ import annotations

import re
import tomllib
from fnmatch import fnmatch
from importlib.metadata import version as version_of
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

from cobotwire_codegen.emit import write
from cobotwire_codegen.project import SITE, editions, products

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
# Otherwise each setter lists "ack_within", which its class describes, and the return type None.
autodoc_typehints_description_target = "documented"
autodoc_member_order = "bysource"
autodoc_class_signature = "mixed"
autoclass_content = "both"
napoleon_google_docstring = True
napoleon_numpy_docstring = False
# Otherwise Sphinx describes the fields of a named tuple twice.
napoleon_use_ivar = True

html_theme = "furo"
# The site is that of the main branch; the title says which version that is.
html_title = f"cobotwire {version}"
html_static_path = ["_static", "pictures"]
html_css_files = ["site.css"]
ROOT = Path(__file__).parents[1]
_PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
REPOSITORY = _PROJECT["project"]["urls"]["Repository"]
html_theme_options = {
    # For "edit this page".
    "source_repository": f"{REPOSITORY}/",
    "source_branch": "main",
    "source_directory": "docs/",
}
html_show_sphinx = False
# Each page links to its source in the repository.
html_copy_source = False


def _add_pages(app: Sphinx, page: str, source: list[str]) -> None:
    """List below the front page of each edition the other pages of its folder."""
    if fnmatch(page, "reference/*/README"):
        source[0] += "\n```{toctree}\n:hidden:\n:glob:\n\n*\n```\n"


def _collapse(app: Sphinx, page: str, template: str, context: dict[str, Any], tree: object) -> None:
    """Show the pages of an edition only to readers of that edition.

    Otherwise each page has a link to every page of every edition, and the build takes longer.
    """
    whole = context.get("toctree")
    if whole is not None:
        context["toctree"] = lambda **options: whole(**{**options, "collapse": True})


def _edit_spec(
    app: Sphinx, page: str, template: str, context: dict[str, Any], tree: object
) -> None:
    """Let "edit this page" lead to the spec if the page is generated from it."""
    if page.startswith("reference/") and context.get("page_source_suffix"):
        context["theme_source_edit_link"] = f"{REPOSITORY}/tree/main/spec"


def _without_noise(
    app: Sphinx, what: str, name: str, thing: object, options: object, signature: str, returns: str
) -> tuple[str, str] | None:
    """Omit the signature of a class that only Python creates, such as an enum or a protocol."""
    return ("", returns) if what == "class" and "*args" in (signature or "") else None


def _as_sections(
    app: Sphinx, what: str, name: str, thing: object, options: object, lines: list[str]
) -> None:
    """Write the lines "Returns: ..." and "Safety: ..." of a command's docstring as paragraphs."""
    text = re.sub(r"\n(Returns|Safety): (.*(?:\n +.*)*)", _section, "\n".join(lines))
    lines[:] = text.splitlines()


def _section(found: re.Match[str]) -> str:
    words = " ".join(found[2].split())
    return f"\n\nReturns:\n    {words}\n" if found[1] == "Returns" else f"\n\nSafety: {words}\n"


def setup(app: Sphinx) -> None:
    """Write the generated pages; change all pages before the theme (priority 500) writes them."""
    for target in products(ROOT, editions(ROOT), SITE):
        write(target)
    app.connect("autodoc-process-signature", _without_noise)
    # Before napoleon (priority 500) reads the docstring.
    app.connect("autodoc-process-docstring", _as_sections, priority=400)
    app.connect("html-page-context", _edit_spec, priority=400)
    app.connect("source-read", _add_pages)
    app.connect("html-page-context", _collapse, priority=400)
