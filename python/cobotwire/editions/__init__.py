"""Find editions of the protocol by name. Each edition is a generated package."""

from __future__ import annotations

import os
import sys
from importlib import import_module
from typing import TYPE_CHECKING, Any, Protocol

from cobotwire.editions.clients import EDITIONS
from cobotwire.protocol.errors import UsageError, did_you_mean

if TYPE_CHECKING:
    from cobotwire.client import Client
    from cobotwire.client.aio import AsyncClient
    from cobotwire.protocol.table import Table

DEFAULT = "mycobot280"


class Edition(Protocol):
    """The package of an edition."""

    TABLE: Table
    CLIENT: type[Client]
    ASYNC_CLIENT: type[AsyncClient]


def names() -> list[str]:
    """Return the names of the editions that come with cobotwire."""
    return sorted({*EDITIONS.values()})


def load(name: str = DEFAULT) -> Edition:
    """Return the edition called ``name``: one that comes with cobotwire, or a package of your own.

    Name your own package as in an ``import`` statement, or by the path of its folder.

    Raises:
        UsageError: there is no edition of that name, or the package is not an edition.
    """
    if name in EDITIONS.values():
        edition: Any = import_module(f"{__name__}.{name}")
        return edition  # type: ignore[no-any-return]
    if os.path.isfile(os.path.join(name, "__init__.py")):
        folder, name = os.path.split(os.path.realpath(name))
        sys.path.insert(0, folder)
    package: Any
    try:
        package = import_module(name)
    except (ModuleNotFoundError, ValueError, TypeError):
        part = [each for each in names() if len(name) > 2 and name in each][:1]
        hint = did_you_mean(name, names()) or "".join(f"; did you mean {each}?" for each in part)
        hint = hint or f"; choose from {', '.join(names())}"
        message = f"there is no edition {name!r}{hint}"
        if os.path.isfile(name):
            message = f"{name!r} is a file: generate a package from it with cobotwire-gen build"
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
