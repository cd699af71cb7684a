"""Configure the docs site (``make docs``): warnings are errors, and nothing is fetched."""

from __future__ import annotations

import re
import sys
import tomllib
from importlib.metadata import version as version_of
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx

from cobotwire_codegen.emit import write
from cobotwire_codegen.project import SITE, confirmed_table, editions, products

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))
sys.path.insert(0, str(Path(__file__).parent))
from robot_picture import picture
from site_search import UserWords, name_commands

import live_page

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
# Otherwise each setter lists "ack_within", which the class describes, and the return type None.
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
EDITIONS = editions(ROOT)
CONFIRMED = confirmed_table(ROOT, EDITIONS)
COMMANDS = {each.name: each.by_name for each in EDITIONS}
_PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
REPOSITORY = _PROJECT["project"]["urls"]["Repository"]
html_theme_options = {
    # For "edit this page".
    "source_repository": f"{REPOSITORY}/",
    "source_branch": "main",
    "source_directory": "docs/",
}
html_show_sphinx = False
# The search and the sidebar find what these list.
html_use_index = html_domain_indices = False
html_search_scorer = str(Path(__file__).with_name("search_order.js"))
# Each page links to its source in the repository.
html_copy_source = False

# The former address of each page that moved, and its new one.
MOVED = {"exchange": "contribute/exchange", "attack": "contribute/attack"}


def _lead_on(app: Sphinx, error: Exception | None) -> None:
    """Let the address of a page that moved lead to its new one."""
    for old, new in MOVED.items() if app.builder.format == "html" else ():
        link = (
            f'<meta http-equiv="refresh" content="0; url={new}.html"><a href="{new}.html">moved</a>'
        )
        Path(app.outdir, f"{old}.html").write_text(link, "utf-8")


def _build_live(app: Sphinx, error: Exception | None) -> None:
    """Add the page that drives an arm in the browser."""
    if app.builder.format == "html":
        live_page.build(Path(app.outdir, "live"), lambda: EDITIONS)


def _add_robots(app: Sphinx, page: str, source: list[str]) -> None:
    """Complete the overview of robots, list their pages below it, and draw the arm of each."""
    if page == "robots":
        source[0] = source[0].replace("<!-- confirmed -->", CONFIRMED)
        source[0] += "\n```{toctree}\n:hidden:\n:glob:\n\nrobots/mycobot280\nrobots/*\n```\n"
    if page.startswith("robots/"):
        name = page.rpartition("/")[2]
        source[0] = re.sub("^<!-- picture -->$", lambda _: picture(name), source[0], flags=re.M)


def _name_commands(app: Sphinx, document: nodes.document) -> None:
    """Add what each command of an edition does to the search index."""
    folder, _, rest = app.env.docname.partition("/")
    if folder == "reference" and (commands := COMMANDS.get(rest.partition("/")[0])):
        name_commands(document, commands)


def _collapse(app: Sphinx, page: str, template: str, context: dict[str, Any], tree: object) -> None:
    """Fold the sections of the sidebar, and show the pages of a robot only to its readers.

    Otherwise each page has a link to every page of every robot, and the build takes longer.
    """
    whole = context.get("toctree")
    if whole is not None:
        context["toctree"] = lambda **options: _folded(whole(**{**options, "collapse": True}))


def _folded(tree: str) -> str:
    """Return the sidebar with a fold for each section.

    The section of the page is open; on a page outside of all sections, the first two are.
    """
    caption = r'<p class="caption".*?<span class="caption-text">(.*?)</span></p>'
    _, *parts = re.split(caption, tree)
    sections = list(zip(parts[::2], parts[1::2]))
    current = [n for n, (_, links) in enumerate(sections) if 'class="current"' in links] or [0, 1]
    return "".join(
        f"<details{' open' * (n in current)}><summary>{name}</summary>{links}</details>"
        for n, (name, links) in enumerate(sections)
    )


def _edit_spec(
    app: Sphinx, page: str, template: str, context: dict[str, Any], tree: object
) -> None:
    """Let "edit this page" lead to the spec if the page is generated from it."""
    if page.startswith(("reference/", "robots/")) and context.get("page_source_suffix"):
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
    for target in products(ROOT, EDITIONS, SITE):
        write(target)
    app.add_search_language(UserWords)
    app.connect("autodoc-process-signature", _without_noise)
    # Before napoleon (priority 500) reads the docstring.
    app.connect("autodoc-process-docstring", _as_sections, priority=400)
    app.connect("html-page-context", _edit_spec, priority=400)
    app.connect("source-read", _add_robots)
    app.connect("doctree-read", _name_commands)
    app.connect("html-page-context", _collapse, priority=400)
    app.connect("build-finished", _lead_on)
    app.connect("build-finished", _build_live)
