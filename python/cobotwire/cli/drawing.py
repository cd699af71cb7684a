"""What draws, for the verbs that can; only they need matplotlib."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from cobotwire.errors import UsageError


def drawing(what: str) -> Any:
    """The module of ``cobotwire.plot`` of that name.

    Raises:
        UsageError: matplotlib is not there.
    """
    try:
        return import_module(f"cobotwire.plot.{what}")
    except ModuleNotFoundError as error:
        if error.name != "matplotlib":
            raise
        raise UsageError("plot", "without matplotlib", "pip install 'cobotwire[plot]'") from None
