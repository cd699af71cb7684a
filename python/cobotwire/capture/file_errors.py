"""Explain why a file cannot be opened, in the same words everywhere."""

from __future__ import annotations

import os

from cobotwire.protocol.errors import UsageError

REASONS: tuple[tuple[type[Exception], str], ...] = (
    (FileNotFoundError, "no such file"),
    (FileExistsError, "the file exists already; it is not overwritten"),
)


def unusable_file(argument: str, path: str | os.PathLike[str], error: Exception) -> UsageError:
    """Return the error for a file that cannot be opened, created or written."""
    reason: object = getattr(error, "strerror", None) or error
    for kind, text in REASONS:
        if isinstance(error, kind):
            reason = text
    return UsageError(argument, str(path), message=f"{path}: {reason}")
