"""The digest of the code that runs and checks the test cases."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from hashlib import sha256
from importlib.resources import files
from importlib.resources.abc import Traversable

PACKAGE = "cobotwire.conformance"
# What writes and shows results does not change them.
LEFT_OUT = ("reports", "catalogue")


@cache
def code_digest() -> str:
    """Return the SHA-256 of the modules of the testers; it names the exact code of a run."""
    hashed = sha256()
    for name, module in sorted(_modules(files(PACKAGE), "")):
        hashed.update(f"{name}\n".encode())
        hashed.update(module.read_bytes().replace(b"\r\n", b"\n"))
    return hashed.hexdigest()


def _modules(folder: Traversable, path: str) -> Iterator[tuple[str, Traversable]]:
    for entry in folder.iterdir():
        name = f"{path}{entry.name}"
        if entry.is_dir():
            if name not in LEFT_OUT:
                yield from _modules(entry, f"{name}/")
        elif name.endswith(".py"):
            yield name, entry
