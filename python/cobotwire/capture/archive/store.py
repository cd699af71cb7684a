"""Hold the files of an export: a folder, or a place in an object store."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Protocol

from cobotwire.capture.export.atomic_file import output_error
from cobotwire.capture.export.inputs import is_url, store_of
from cobotwire.protocol.errors import OutputError


class Store(Protocol):
    """A folder of files. Names are relative to it, with ``/`` between their parts."""

    def filled(self, name: str) -> AbstractContextManager[str]:
        """Yield a local folder. After the context its files are in the folder ``name``.

        Raises:
            OutputError: the store does not take the files.
        """
        ...

    def mark(self, name: str) -> None:
        """Write an empty file.

        Raises:
            OutputError: the store does not take it.
        """
        ...

    def has(self, name: str) -> bool:
        """Return whether a file exists."""
        ...

    def names(self) -> list[str]:
        """Return the names of all files except hidden ones.

        Raises:
            OutputError: the store does not list them.
        """
        ...

    def move(self, name: str, to: str) -> None:
        """Rename a file; replace a file that already has the new name.

        Raises:
            OutputError: the file cannot be moved.
        """
        ...

    def remove(self, name: str) -> None:
        """Remove a file, or a folder with everything in it; do nothing if it does not exist."""
        ...


def store_at(output: str) -> Store:
    """Return the store at a path or an fsspec URL.

    Raises:
        UsageError: no store has such a URL, or its package is not installed.
    """
    return _Objects(output) if is_url(output) else _Folder(output)


class _Folder:
    def __init__(self, path: str) -> None:
        self._path = Path(path).absolute()

    @contextmanager
    def filled(self, name: str) -> Iterator[str]:
        yield str(self._path / name)

    def mark(self, name: str) -> None:
        path = self._path / name
        try:
            path.parent.mkdir(parents=True)
            path.touch()
        except OSError as error:
            raise output_error(path, error) from error

    def has(self, name: str) -> bool:
        return (self._path / name).exists()

    def names(self) -> list[str]:
        found = []
        for parent, folders, files in os.walk(self._path):
            folders[:] = [name for name in folders if not name.startswith(".")]
            relative = Path(parent).relative_to(self._path)
            found += [(relative / name).as_posix() for name in files if not name.startswith(".")]
        return sorted(found)

    def move(self, name: str, to: str) -> None:
        target = self._path / to
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            os.replace(self._path / name, target)
        except OSError as error:
            raise output_error(target, error) from error

    def remove(self, name: str) -> None:
        path = self._path / name
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)


class _Objects:
    def __init__(self, url: str) -> None:
        self._url = url.rstrip("/")
        self._store, path = store_of(self._url, "output")
        self._path = path.rstrip("/")

    @contextmanager
    def filled(self, name: str) -> Iterator[str]:
        with TemporaryDirectory(prefix="cobotwire-") as folder:
            yield folder
            for file in sorted(path for path in Path(folder).rglob("*") if path.is_file()):
                target = f"{name}/{file.relative_to(folder).as_posix()}"
                try:
                    self._store.put_file(str(file), f"{self._path}/{target}")
                except OSError as error:
                    raise self._failed(target, error) from error

    def mark(self, name: str) -> None:
        bucket = self._path.partition("/")[0]
        if bucket and not self._store.exists(bucket):
            # The store would create it, although its name is probably wrong.
            raise OutputError(self._url, f"there is no bucket {bucket}")
        try:
            self._store.makedirs(f"{self._path}/{name}".rpartition("/")[0], exist_ok=True)
            self._store.pipe_file(f"{self._path}/{name}", b"")
        except OSError as error:
            raise self._failed(name, error) from error

    def has(self, name: str) -> bool:
        self._store.invalidate_cache()
        return bool(self._store.exists(f"{self._path}/{name}"))

    def names(self) -> list[str]:
        # The cache would hide files that another process wrote.
        self._store.invalidate_cache()
        start = len(self._path) + 1
        try:
            found = [str(name)[start:] for name in self._store.find(self._path)]
        except FileNotFoundError:
            return []
        except OSError as error:
            raise self._failed("", error) from error
        return sorted(name for name in found if "/." not in f"/{name}")

    def move(self, name: str, to: str) -> None:
        try:
            self._store.makedirs(f"{self._path}/{to}".rpartition("/")[0], exist_ok=True)
            self._store.mv(f"{self._path}/{name}", f"{self._path}/{to}")
        except OSError as error:
            raise self._failed(to, error) from error

    def remove(self, name: str) -> None:
        if self.has(name):
            self._store.rm(f"{self._path}/{name}", recursive=True)

    def _failed(self, name: str, error: OSError) -> OutputError:
        return OutputError(f"{self._url}/{name}".rstrip("/"), error.strerror or str(error))
