"""Draw pictures into files; matplotlib is imported only when one is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from cobotwire.inspect.plot.series import Series
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Table

SUFFIXES = (".png", ".svg", ".pdf")


def check_output(path: str) -> None:
    """Check that a picture can be drawn into a file of that name.

    Raises:
        UsageError: the suffix names no known format, or matplotlib is not installed.
    """
    if Path(path).suffix.lower() not in SUFFIXES:
        raise UsageError("output", path, f"a file name that ends in {', '.join(SUFFIXES)}")
    _module("charts")


def draw_charts(series: Series, path: str, title: str) -> None:
    """Draw a series over its axis; the suffix of the file chooses the format.

    Raises:
        UsageError: the picture cannot be drawn, or the file cannot be written.
    """
    check_output(path)
    _module("charts").draw(series, path, title)


def draw_pose(table: Table, angles: Sequence[float], path: str) -> None:
    """Draw the arm with its joints at ``angles``, in degrees.

    Raises:
        UsageError: the picture cannot be drawn, the file cannot be written, or the geometry of the
            edition's arm is not known.
    """
    check_output(path)
    _module("pose").draw(table, angles, path)


def _module(name: str) -> Any:
    try:
        return import_module(f"cobotwire.inspect.plot.{name}")
    except ModuleNotFoundError as error:
        if error.name != "matplotlib":
            raise
        message = "plotting needs matplotlib: pip install 'cobotwire[plot]'"
        raise UsageError("output", message=message) from None
