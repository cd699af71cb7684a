"""Import the packages that a purpose needs, or say which extra installs them."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Literal

from cobotwire.protocol.errors import UsageError

Extra = Literal["arrow", "mcap", "fsspec", "zstd", "dask", "ros2"]


def needed(package: str, extra: Extra, purpose: str) -> Any:
    """Return a package.

    Raises:
        UsageError: it is not installed; the text names the extra.
    """
    try:
        return import_module(package)
    except ImportError as error:
        name = package.partition(".")[0]
        message = f"{purpose} needs {name}: pip install 'cobotwire[{extra}]'"
        raise UsageError(package, message=message) from error
