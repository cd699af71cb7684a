"""Configure the docs site (``make docs``): warnings are errors, and nothing is fetched."""

from __future__ import annotations

from importlib.metadata import version as version_of

project = "cobotwire"
author = "the cobotwire engineers"
copyright = "the cobotwire engineers"
version = release = version_of("cobotwire")

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
]
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
