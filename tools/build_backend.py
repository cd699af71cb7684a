"""Build the package for pip: fetch the library of the studio's page, and let maturin do the rest.

pyproject.toml names this module as its build backend (PEP 517), so that `pip wheel .` in a clone,
and `pip install git+...`, make the same package as a release does. Without the npm registry the
package is built without the library; `cobotwire studio` then says so, and --help leaves it out.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

import maturin
from maturin import (
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

import front_end

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "prepare_metadata_for_build_editable",
    "prepare_metadata_for_build_wheel",
]

Settings = Mapping[str, Any] | None
# Without a network, a build waits this long.
front_end.SECONDS = 15


def build_wheel(folder: str, settings: Settings = None, metadata: str | None = None) -> str:
    """Build a wheel in a folder; return its name."""
    _fetch()
    return str(maturin.build_wheel(folder, settings, metadata))


def build_sdist(folder: str, settings: Settings = None) -> str:
    """Build a source distribution in a folder; return its name."""
    _fetch()
    return str(maturin.build_sdist(folder, settings))


def build_editable(folder: str, settings: Settings = None, metadata: str | None = None) -> str:
    """Build a wheel that refers to this folder; return its name."""
    _fetch()
    return str(maturin.build_editable(folder, settings, metadata))


def _fetch() -> None:
    """Fetch what the page needs; report what is left out."""
    try:
        for package in front_end.PACKAGES:
            if package.shipped and not package.present:
                front_end.fetch(package)
    except SystemExit as error:
        text = f"the package is built without `cobotwire studio`, because {error.code}"
        print(f"warning: {text}", file=sys.stderr)
