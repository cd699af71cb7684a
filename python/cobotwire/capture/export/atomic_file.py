"""Write a file under a temporary name beside its final one; publish it when it is complete.

So a file with a final name is never half written, whatever ends the process.
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

from cobotwire.protocol.errors import OutputError, UsageError

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
        file: the open temporary file.
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
            self.file: BinaryIO = self._open_locked()
            self.file.truncate()
        except OSError as error:
            raise output_error(path, error) from error

    def _refuse_existing(self) -> None:
        if not self._overwrite and os.path.lexists(self.path):
            raise existing(self.path)

    def _open_locked(self) -> BinaryIO:
        while True:
            file = open(self._temporary, "ab")  # noqa: SIM115  (closed by publish)
            if fcntl is None:
                return file
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                file.close()
                message = f"{self.path}: another export is writing this file"
                raise UsageError("output", str(self.path), message=message) from None
            with suppress(FileNotFoundError):
                if os.path.samestat(os.fstat(file.fileno()), os.stat(self._temporary)):
                    return file
            # Another export has published or removed the file between open and lock.
            file.close()

    def finish(self) -> int:
        """Write the file to the disk; return its size in bytes.

        Raises:
            OutputError: the system cannot write it.
        """
        try:
            self.file.flush()
            os.fsync(self.file.fileno())
            return os.fstat(self.file.fileno()).st_size
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
            self.file.close()
            _sync_folder(self.path.parent)
        except OSError as error:
            raise output_error(self.path, error) from error

    def discard(self) -> None:
        """Remove the temporary file; do nothing after :meth:`publish`."""
        if not self._published:
            with suppress(OSError):
                self._temporary.unlink()
            with suppress(OSError):
                self.file.close()


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
