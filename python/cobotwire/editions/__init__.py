"""The editions of the protocol: one generated package each, found by name."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, cast

from cobotwire.protocol.errors import UsageError

if TYPE_CHECKING:
    from cobotwire.client import Client
    from cobotwire.client.aio import AsyncClient
    from cobotwire.protocol.table import Table

DEFAULT = "mycobot"


class Edition(Protocol):
    """What an edition's package holds."""

    TABLE: Table
    CLIENT: type[Client]
    ASYNC_CLIENT: type[AsyncClient]


def names() -> list[str]:
    """The editions that come with cobotwire."""
    from pkgutil import iter_modules

    return sorted(module.name for module in iter_modules(__path__) if module.ispkg)


def load(name: str = DEFAULT) -> Edition:
    """The edition called ``name``: one that comes with cobotwire, or a package of your own.

    Your own package is found as any import is, and also by the path of its folder.

    Raises:
        UsageError: there is no such edition, or the package is none.
    """
    # Here, not above: whoever imports an edition by its name runs this module, and needs no search.
    import sys
    from importlib import import_module
    from pathlib import Path

    if name in names():
        return cast(Edition, import_module(f"cobotwire.editions.{name}"))
    folder = Path(name)
    if (folder / "__init__.py").is_file():
        sys.path.insert(0, str(folder.resolve().parent))
        name = folder.resolve().name
    try:
        package = import_module(name)
    except (ModuleNotFoundError, ValueError, TypeError):
        from difflib import get_close_matches

        near = get_close_matches(name, names(), n=1)
        hint = f"; did you mean {near[0]}?" if near else ""
        allowed = f"one of {', '.join(names())}, or a package that cobotwire-gen build made{hint}"
        raise UsageError("edition", name, allowed) from None
    if not hasattr(package, "TABLE") or not hasattr(package, "CLIENT"):
        raise UsageError("edition", name, "a package that cobotwire-gen build made")
    return cast(Edition, package)
