"""Write a file under a temporary name beside its final one; publish it when it is complete.

So a file with a final name is never half written, whatever ends the process.
"""

from __future__ import annotations

import io
import os
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from cobotwire.protocol.errors import OutputError, UsageError

if TYPE_CHECKING:
    from typing_extensions import Buffer

try:
    import fcntl
except ImportError:  # Windows: two exports into one folder at a time are not detected there.
    fcntl = None  # type: ignore[assignment]

# Readers of data sets ignore files with a leading dot.
_SUFFIX = ".cobotwire-tmp"


class AtomicFile:
    """A file that is being written.

    A temporary file that a killed export left behind is written anew. It is locked, so that two
    exports cannot write one file at the same time.

    Attributes:
        path: the final name.
        file: what the content is written to.
    """

    def __init__(self, path: Path, overwrite: bool) -> None:
        """Create the temporary file, and the folders above it.

        Raises:
            UsageError: the final name is taken, or another export is writing it.
            OutputError: the file cannot be created.
        """
        self.path, self._overwrite = path, overwrite
        self._published = False
        self._temporary = path.with_name(f".{path.name}{_SUFFIX}")
        self._refuse_existing()
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._stored = self._open_locked()
        except OSError as error:
            raise output_error(path, error) from error
        self.file = WritableFile(self._stored)

    def _refuse_existing(self) -> None:
        if not self._overwrite and os.path.lexists(self.path):
            raise existing(self.path)

    def _open_locked(self) -> BinaryIO:
        while True:
            file = open(self._temporary, "ab")  # noqa: SIM115  (closed by publish and discard)
            try:
                if self._lock(file):
                    # Devices cannot be truncated.
                    if os.fstat(file.fileno()).st_size:
                        file.truncate(0)
                    return file
            except BaseException:
                file.close()
                raise
            file.close()

    def _lock(self, file: BinaryIO) -> bool:
        """Lock the temporary file; return False if it has got another name in the meantime."""
        if fcntl is None:
            return True
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            message = f"{self.path}: another export is writing this file"
            raise UsageError("output", str(self.path), message=message) from None
        try:
            return os.path.samestat(os.fstat(file.fileno()), os.stat(self._temporary))
        except FileNotFoundError:
            return False

    def finish(self) -> int:
        """Write the file to the disk; return its size in bytes.

        Raises:
            OutputError: the system cannot write it.
        """
        try:
            self._stored.flush()
            os.fsync(self._stored.fileno())
            return os.fstat(self._stored.fileno()).st_size
        except OSError as error:
            raise output_error(self.path, error) from error

    def publish(self) -> None:
        """Give the file its final name.

        Raises:
            UsageError: the final name was taken in the meantime.
            OutputError: the file cannot be renamed.
        """
        self._refuse_existing()
        try:
            os.replace(self._temporary, self.path)
            self._published = True
            self._stored.close()
            _sync_folder(self.path.parent)
        except OSError as error:
            raise output_error(self.path, error) from error

    def discard(self) -> None:
        """Remove the temporary file; do nothing after :meth:`publish`."""
        self.file.discarded = True
        if not self._published:
            with suppress(OSError):
                self._temporary.unlink()
            with suppress(OSError):
                self._stored.close()


class WritableFile(io.BufferedIOBase):
    """A file that can only be written; closing it leaves the file below it open.

    Attributes:
        discarded: whether further bytes are ignored. Writers of formats write an end when they are
            closed, also if their file has failed.
    """

    def __init__(self, file: BinaryIO) -> None:
        super().__init__()
        self._file = file
        self._size = 0
        self.discarded = False

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
        return size if self.discarded else self._file.write(data)


def existing(path: Path) -> UsageError:
    """Return the error for an output that exists."""
    message = f"{path} exists already; --overwrite replaces it"
    return UsageError("output", str(path), message=message)


def output_error(path: Path, error: OSError) -> OutputError:
    """Return the error for a file that the system cannot write."""
    return OutputError(str(path), error.strerror or str(error))


def _sync_folder(folder: Path) -> None:
    """Write the names in a folder to the disk, where the system can do that."""
    with suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
