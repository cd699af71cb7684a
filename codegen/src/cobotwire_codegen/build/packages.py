"""Finds the specs that installed packages ship.

A package ships its editions as ``spec/editions/NAME.yaml`` in its own folder, as ``cobotwire``
does. The package is found, not imported: none of its code runs.
"""

from __future__ import annotations

import re
from importlib.util import find_spec
from pathlib import Path

from cobotwire_codegen.errors import Place, Problem, SpecError, nearest
from cobotwire_codegen.language.names import IN_PACKAGE


def names_package(base: str) -> bool:
    """Return whether a base is an edition of a package, such as ``cobotwire:mycobot280``."""
    return re.search(IN_PACKAGE, base) is not None


def packaged_edition(base: str, place: Place) -> Path:
    """Return the edition file that a package ships.

    Args:
        base: the package and the edition, such as ``cobotwire:mycobot280``.
        place: where the spec names them.

    Raises:
        SpecError: the package is not installed, or it has no such edition.
    """
    package, _, edition = base.partition(":")
    folders = _folders(package)
    if not folders:
        message = f"the package {package} is not installed: pip install {package}"
        raise SpecError([Problem(place, "no-package", message)])
    shipped = _shipped(folders)
    if edition not in shipped:
        message = f"the package {package} ships no edition {edition}{nearest(edition, shipped)}"
        raise SpecError([Problem(place, "no-file", message)])
    return shipped[edition]


def packaged_hint(name: str) -> str:
    """Return a hint for a base that does not exist, if ``cobotwire`` ships its edition."""
    edition = name.removesuffix(".yaml")
    known = edition in _shipped(_folders("cobotwire"))
    return f"; did you mean cobotwire:{edition}?" if known else ""


def _folders(package: str) -> list[str]:
    found = find_spec(package)
    return list((found and found.submodule_search_locations) or ())


def _shipped(folders: list[str]) -> dict[str, Path]:
    files = (path for folder in folders for path in Path(folder).glob("spec/editions/*.yaml"))
    return {path.stem: path for path in files}
