"""Find the behaviours of devices that other packages or modules provide.

A package provides them by an entry point of the group ``cobotwire.behaviours``, named like its
edition; a user names a module.
"""

from __future__ import annotations

import sys
from functools import cache
from importlib import import_module
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

from cobotwire.protocol.errors import UsageError
from cobotwire.simulator.behaviour.registry import Behaviours

GROUP = "cobotwire.behaviours"
NAME = "behaviours"


@cache
def installed(edition: str) -> Behaviours:
    """Return the behaviours that installed packages provide for an edition.

    Raises:
        UsageError: an entry point does not refer to a ``Behaviours``.
    """
    found = Behaviours()
    for point in entry_points(group=GROUP, name=edition):
        found |= _checked(point.load(), f"the entry point {point.name} = {point.value}")
    return found


def named(module: str) -> Behaviours:
    """Return the ``behaviours`` of a module: its name as in an ``import`` statement, or its file.

    Raises:
        UsageError: there is no such module, or it has no ``Behaviours`` of that name.
    """
    name, path = module, Path(module)
    if path.suffix == ".py":
        if not path.is_file():
            raise UsageError("behaviours", module, message=f"{module}: no such file")
        sys.path.insert(0, str(path.resolve().parent))
        name = path.stem
    try:
        found = import_module(name)
    except ImportError as error:
        message = f"the module {module} cannot be imported: {error}"
        raise UsageError("behaviours", module, message=message) from None
    return _checked(getattr(found, NAME, None), f"{module} ({NAME})")


def _checked(found: Any, what: str) -> Behaviours:
    if isinstance(found, Behaviours):
        return found
    message = f"{what} is not a Behaviours of cobotwire.simulator.behaviour"
    raise UsageError("behaviours", what, message=message)
