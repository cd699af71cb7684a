"""Read blocks of bytes, of any sizes, as a file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Generic, TypeVar

from cobotwire.capture.block_parsing import Closable

Origin = TypeVar("Origin")


class BlockFile(Generic[Origin]):
    """Reads blocks, which may come from a ``file`` that is closed with this one.

    Attributes:
        origin: where the blocks come from, if that is known.
    """

    def __init__(
        self, blocks: Iterator[bytes], file: Closable | None = None, origin: Origin | None = None
    ) -> None:
        self.origin = origin
        self._blocks, self._file = blocks, file
        self._rest = memoryview(b"")

    def read(self, size: int, /) -> bytes:
        """Return some bytes, at most ``size``; none at the end."""
        if not self._rest:
            self._rest = memoryview(next(self._blocks, b""))
        data, self._rest = self._rest[:size].tobytes(), self._rest[size:]
        return data

    def close(self) -> None:
        """Close the file."""
        if self._file:
            self._file.close()
