"""Read any part of a stored capture: a file, or an object in a store."""

from __future__ import annotations

from types import TracebackType
from typing import Protocol, Self

from cobotwire.capture.export.inputs import Input, is_url, store_of
from cobotwire.capture.file_errors import unusable_file
from cobotwire.protocol.errors import LinkError


class Stored:
    """An input with the size that it had when it was found; bytes added later are ignored.

    Attributes:
        size: the number of bytes.
    """

    def __init__(self, input: Input) -> None:
        """Open an input of known size.

        Raises:
            UsageError: it cannot be opened, or a package is missing.
        """
        assert input.size is not None, "only files and objects are divided"
        self.size = input.size
        self._url = input.url
        self._ranges: _Ranges
        try:
            self._ranges = _Object(input.url) if is_url(input.url) else _File(input.url)
        except (OSError, ValueError) as error:
            raise unusable_file("INPUT", input.url, error) from None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._ranges.close()

    def read(self, offset: int, size: int) -> bytes:
        """Return ``size`` bytes from ``offset`` on, or as many as there are.

        Raises:
            LinkError: reading failed, or the input has become shorter.
        """
        wanted = max(0, min(size, self.size - offset))
        try:
            data = self._ranges.read(offset, wanted) if wanted else b""
        except OSError as error:
            raise LinkError(self._url, f"reading failed: {error.strerror or error}") from error
        if len(data) < wanted:
            detail = f"it ends at byte {offset + len(data)} instead of {self.size}: did it change?"
            raise LinkError(self._url, detail)
        return data


class _Ranges(Protocol):
    """Reads ranges of bytes."""

    def read(self, offset: int, size: int) -> bytes:
        """Return the bytes of a range, fewer only at the end."""
        ...

    def close(self) -> None:
        """Release the file."""
        ...


class _File:
    def __init__(self, path: str) -> None:
        self._file = open(path, "rb", buffering=0)  # noqa: SIM115  (closed by Stored)

    def read(self, offset: int, size: int) -> bytes:
        self._file.seek(offset)
        data = self._file.read(size)
        # The system may return less, and returns at most 2 GiB.
        while data and len(data) < size:
            more = self._file.read(size - len(data))
            if not more:
                break
            data += more
        return data

    def close(self) -> None:
        self._file.close()


class _Object:
    """An object in a store: each read is one request for a range."""

    def __init__(self, url: str) -> None:
        self._store, self._path = store_of(url)

    def read(self, offset: int, size: int) -> bytes:
        data: bytes = self._store.cat_file(self._path, start=offset, end=offset + size)
        return data

    def close(self) -> None:
        pass
