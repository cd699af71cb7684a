"""Log without loading ``logging``, which takes a third as long as starting Python.

A program that never imports ``logging`` has not configured it either, so nothing below a warning
is shown.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from cobotwire.protocol.lazy import import_aside

if TYPE_CHECKING:
    from logging import Logger

# The numbers of these levels in ``logging``.
DEBUG = 10
INFO = 20


class Log:
    """A logger of the standard library, which is loaded when it can matter."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._loaded: Logger | None = None

    def find(self) -> Logger | None:
        """Return the logger; None if it logs only warnings, since nobody has configured it."""
        if self._loaded is None and "logging" in sys.modules:
            return self.load()
        return self._loaded

    def load(self) -> Logger:
        """Return the logger."""
        if self._loaded is None:
            import_aside("logging")
            import logging

            library = logging.getLogger("cobotwire")
            if not library.handlers:
                # Without a handler of its own a library's warnings go to stderr.
                library.addHandler(logging.NullHandler())
            self._loaded = logging.getLogger(self._name)
        return self._loaded

    def info(self, message: str, *arguments: object) -> None:
        """Log a message at INFO."""
        logger = self.find()
        if logger is not None:
            logger.info(message, *arguments)
