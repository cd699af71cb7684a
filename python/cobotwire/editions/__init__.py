"""Find editions of the protocol by name. Each edition is a generated package."""

from __future__ import annotations

from cobotwire.protocol.light import TYPE_CHECKING

if TYPE_CHECKING:
    from typing import Any, Protocol

    from cobotwire.client import Client
    from cobotwire.client.aio import AsyncClient
    from cobotwire.protocol.table import Table
else:
    # Only type checkers compare packages with it.
    Protocol = object

DEFAULT = "mycobot280"


class Edition(Protocol):
    """The package of an edition."""

    TABLE: Table
    CLIENT: type[Client]
    ASYNC_CLIENT: type[AsyncClient]


def names() -> list[str]:
    """Return the names of the editions that come with cobotwire."""
    from pkgutil import iter_modules

    return sorted(module.name for module in iter_modules(__path__) if module.ispkg)


def load(name: str = DEFAULT) -> Edition:
    """Return the edition called ``name``: one that comes with cobotwire, or a package of your own.

    Name your own package as in an ``import`` statement, or by the path of its folder.

    Raises:
        UsageError: there is no edition of that name, or the package is not an edition.
    """
    # Imported here, because importing an edition directly runs this module but not this search.
    from importlib import import_module
    from importlib.util import find_spec

    # Looking for one package takes a tenth of the time that listing all of them takes.
    found = find_spec(f"{__name__}.{name}") if name.isidentifier() else None
    if found is not None and found.submodule_search_locations:
        edition: Any = import_module(found.name)
        return edition  # type: ignore[no-any-return]
    import sys
    from pathlib import Path

    from cobotwire.protocol.errors import UsageError, did_you_mean

    folder = Path(name)
    if (folder / "__init__.py").is_file():
        sys.path.insert(0, str(folder.resolve().parent))
        name = folder.resolve().name
    package: Any
    try:
        package = import_module(name)
    except (ModuleNotFoundError, ValueError, TypeError):
        hint = did_you_mean(name, names()) or f"; choose from {', '.join(names())}"
        message = f"there is no edition {name!r}{hint}"
        raise UsageError("edition", name, message=message) from None
    try:
        complete = hasattr(package, "TABLE") and hasattr(package, "CLIENT")
    except ImportError as error:
        message = f"{name}: {error}; generate the package again with cobotwire-gen"
        raise UsageError("edition", name, message=message) from error
    if not complete:
        message = f"{name} is not the package of an edition; make one with cobotwire-gen build"
        raise UsageError("edition", name, message=message)
    return package  # type: ignore[no-any-return]
