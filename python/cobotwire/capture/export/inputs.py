"""Find what an export reads: files, folders, patterns, standard input, fsspec URLs."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from glob import glob, has_magic
from typing import Any

from cobotwire.capture.compression import Compression
from cobotwire.capture.export.extras import needed
from cobotwire.protocol.errors import LinkError, UsageError

STDIN = "-"
COMPRESSED: dict[str, Compression] = {".gz": "gzip", ".zst": "zstd"}
_ENDINGS = (".pcapng", ".pcap", ".cap", ".bin", ".raw", ".hex", ".txt", ".log", ".csv")
_HIVE_ROBOT = re.compile(r"(?:^|/)robot=([^/]+)/")


@dataclass(frozen=True, slots=True)
class Input:
    """A capture: a file, an object in a store, or standard input.

    Attributes:
        url: a path, an fsspec URL, or ``-``.
        size: the number of stored bytes; None if it is not known.
        listed: whether it was found in a folder or by a pattern; False: its own name was given.
    """

    url: str
    size: int | None = None
    listed: bool = field(default=False, compare=False)

    @property
    def robot(self) -> str:
        """The name of its robot: from a folder ``robot=NAME``, or else the name of the input."""
        url = self.url.replace(os.sep, "/")
        if found := _HIVE_ROBOT.search(url):
            return found[1]
        name = url.rpartition("/")[2]
        for ending in (*COMPRESSED, *_ENDINGS):
            name = name.removesuffix(ending)
        return "stdin" if url == STDIN else name


@dataclass(frozen=True, slots=True)
class Inputs:
    """The inputs of an export, in the order in which they are read."""

    files: tuple[Input, ...]

    @property
    def size(self) -> int | None:
        """The number of stored bytes; None if it is not known."""
        total = 0
        for file in self.files:
            if file.size is None:
                return None
            total += file.size
        return total

    @classmethod
    def find(cls, arguments: Sequence[str]) -> Inputs:
        """Return the files that arguments name.

        A folder means all files in it and below it, without hidden ones. A pattern means the files
        that match. Both are sorted by name. An argument with ``://`` is an fsspec URL, which may
        also name a folder or be a pattern.

        Raises:
            UsageError: an argument names nothing, or fsspec is missing.
            LinkError: a store cannot be listed.
        """
        found = dict.fromkeys(file for argument in arguments for file in _files(argument))
        if len(found) > 1 and any(file.url == STDIN for file in found):
            message = "- is standard input; it cannot be combined with files"
            raise UsageError("INPUT", STDIN, message=message)
        return cls(tuple(found))


def is_url(argument: str) -> bool:
    """Return whether an argument is an fsspec URL and not a path."""
    return "://" in argument


def store_of(url: str, argument: str = "INPUT") -> tuple[Any, str]:
    """Return the file system of fsspec for a URL, and the path in it.

    Raises:
        UsageError: fsspec or the package of the store is missing, or there is no such store.
    """
    fsspec = needed("fsspec", "fsspec", f"{'reading' if argument == 'INPUT' else 'writing'} {url}")
    try:
        # The store itself may need a package: the error of fsspec names it.
        store, path = fsspec.url_to_fs(url)
    except (ImportError, ValueError) as error:
        raise UsageError(argument, url, message=f"{url}: {error}") from None
    return store, str(path)


def _files(argument: str) -> Iterator[Input]:
    if argument == STDIN:
        yield Input(STDIN)
    elif is_url(argument):
        yield from _objects(argument)
    else:
        for path in _paths(argument):
            size = os.path.getsize(path) if os.path.isfile(path) else None
            yield Input(path, size, path != argument)


def _paths(argument: str) -> list[str]:
    if os.path.isdir(argument):
        found = sorted(_below(argument))
        return found or _none(argument, "the folder holds no file")
    if has_magic(argument) and not os.path.exists(argument):
        found = sorted(name for name in glob(argument, recursive=True) if os.path.isfile(name))
        return found or _none(argument, "no file matches")
    return [argument] if os.path.exists(argument) else _none(argument, "no such file")


def _below(folder: str) -> Iterator[str]:
    for parent, folders, files in os.walk(folder):
        folders[:] = [name for name in folders if not name.startswith(".")]
        yield from (os.path.join(parent, name) for name in files if name[0] != ".")


def _none(argument: str, why: str) -> list[str]:
    raise UsageError("INPUT", argument, message=f"{argument}: {why}")


def _objects(url: str) -> Iterator[Input]:
    """Yield the objects that an fsspec URL names."""
    store, path = store_of(url)
    try:
        if "::" in url:
            yield Input(url)
            return
        for name, details in sorted(_listed(store, path).items()):
            yield Input(store.unstrip_protocol(name), details.get("size"), name != path)
    except FileNotFoundError:
        _none(url, "no such file")
    except OSError as error:
        raise LinkError(url, f"listing failed: {error}") from error


def _listed(store: Any, path: str) -> dict[str, dict[str, Any]]:
    if has_magic(path):
        found = store.glob(path, detail=True)
    elif store.isdir(path):
        found = store.find(path, detail=True)
    else:
        return {path: store.info(path)}
    kept = {
        name: details
        for name, details in found.items()
        if details["type"] == "file" and not name.rpartition("/")[2].startswith(".")
    }
    if not kept:
        raise FileNotFoundError(path)
    return kept
