"""Write a file under a temporary name beside its final one; publish it when it is complete.

So a file with a final name is never half written, whatever ends the process.
"""

from __future__ import annotations

import io
import os
from contextlib import suppress
from glob import escape
from pathlib import Path
from secrets import token_hex
from typing import TYPE_CHECKING, BinaryIO

from cobotwire.protocol.errors import OutputError, UsageError

if TYPE_CHECKING:
    from typing_extensions import Buffer

try:
    import fcntl
except ImportError:  # Windows, where the temporary files of killed exports are not removed
    fcntl = None  # type: ignore[assignment]

# Readers of data sets ignore files with a leading dot.
_SUFFIX = ".cobotwire-tmp"


class AtomicFile:
    """A file that is being written, under a name that no other export uses.

    The temporary files of killed exports of the same file are removed. A lock shows which files
    belong to exports that are running.

    Attributes:
        path: the final name.
        file: what the content is written to.
    """

    def __init__(self, path: Path, overwrite: bool) -> None:
        """Create the temporary file, and the folders above it.

        Raises:
            UsageError: the final name is taken.
            OutputError: the file cannot be created.
        """
        self.path, self._overwrite = path, overwrite
        self._temporary = path.with_name(f".{path.name}.{token_hex(4)}{_SUFFIX}")
        self._published = False
        self._refuse_existing()
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            _remove_abandoned(path)
            stored = open(self._temporary, "xb")  # noqa: SIM115  (closed by finish and discard)
        except OSError as error:
            raise output_error(path, error) from error
        self._lock: int | None = None
        if fcntl is not None:
            # The file is closed before it gets its final name; a second descriptor keeps the lock.
            self._lock = os.dup(stored.fileno())
            fcntl.flock(self._lock, fcntl.LOCK_EX)
        self.file = WritableFile(stored)

    def _refuse_existing(self) -> None:
        if not self._overwrite and os.path.lexists(self.path):
            message = f"{self.path} exists already; --overwrite replaces it"
            raise UsageError("output", str(self.path), message=message)

    def finish(self) -> int:
        """Write the file to the disk, and close it; return its size in bytes.

        Raises:
            OutputError: the system cannot write it.
        """
        try:
            return self.file.finish()
        except OSError as error:
            raise output_error(self.path, error) from error

    def publish(self) -> None:
        """Finish the file, and give it its final name; :func:`sync_folder` makes the name durable.

        Raises:
            UsageError: the final name was taken in the meantime.
            OutputError: the file cannot be renamed.
        """
        self._refuse_existing()
        # Windows does not rename an open file.
        self.finish()
        try:
            os.replace(self._temporary, self.path)
            self._published = True
        except OSError as error:
            raise output_error(self.path, error) from error
        self._unlock()

    def discard(self) -> None:
        """Remove the temporary file; do nothing after :meth:`publish`."""
        self.file.discard()
        if not self._published:
            with suppress(OSError):
                self._temporary.unlink()
        self._unlock()

    def _unlock(self) -> None:
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None


class WritableFile(io.BufferedIOBase):
    """A file that can only be written; only its owner closes it.

    After :meth:`discard` it ignores writes. When a writer of Parquet, Arrow or another format is
    closed, it writes the end of the format, even if an earlier write failed.
    """

    def __init__(self, stored: BinaryIO) -> None:
        super().__init__()
        self._stored = stored
        self._size = 0
        self._discarded = False

    def writable(self) -> bool:
        """Return True."""
        return True

    def tell(self) -> int:
        """Return the number of bytes that were written."""
        return self._size

    def write(self, data: Buffer, /) -> int:
        """Write all bytes."""
        size = memoryview(data).nbytes
        self._size += size
        return size if self._discarded else self._stored.write(data)

    def finish(self) -> int:
        """Write everything to the disk, and close the stored file; return its size in bytes.

        Finishing twice is harmless.
        """
        if self._stored.closed:
            return self._size
        self._stored.flush()
        os.fsync(self._stored.fileno())
        size = os.fstat(self._stored.fileno()).st_size
        self._stored.close()
        return size

    def discard(self) -> None:
        """Close the stored file, and ignore what is written from now on."""
        self._discarded = True
        with suppress(OSError):
            self._stored.close()


def output_error(path: Path, error: OSError) -> OutputError:
    """Return the error for a file that the system cannot write."""
    return OutputError(str(path), error.strerror or str(error))


def sync_folder(folder: Path) -> None:
    """Write the names in a folder to the disk, where the system can do that."""
    with suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def _remove_abandoned(path: Path) -> None:
    """Remove the temporary files of exports that were killed while they wrote a file."""
    if fcntl is None:
        return
    for left in path.parent.glob(f".{escape(path.name)}.*{_SUFFIX}"):
        with suppress(OSError), left.open("rb") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            left.unlink()
