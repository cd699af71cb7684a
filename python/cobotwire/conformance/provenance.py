"""Where a report comes from: the edition, the test suite and the machine of the run."""

from __future__ import annotations

import platform
from collections.abc import Iterator
from functools import cache
from hashlib import sha256
from importlib.resources import files
from importlib.resources.abc import Traversable

import cobotwire
from cobotwire import editions
from cobotwire.conformance.catalogue import NUMBERS, VERSION
from cobotwire.conformance.privacy import hashed
from cobotwire.conformance.report import Environment, Report
from cobotwire.protocol.loading import stored_file

# The digest omits modules that only write or show results.
NO_TESTERS = ("reports", "catalogue")


def identify(report: Report, edition: str, *, port: str = "") -> None:
    """Write into a report what others need to understand and to repeat the run.

    Args:
        report: the report.
        edition: the name or package of its edition, as ``editions.load`` takes it.
        port: what connects the tester with the subject.
    """
    report.edition_digest = edition_digest(edition)
    report.catalogue = f"{VERSION}"
    report.clauses = dict(NUMBERS)
    report.code_digest = code_digest()
    report.environment = Environment(
        host=hashed(platform.node()),
        system=platform.platform(),
        python=f"{platform.python_implementation()} {platform.python_version()}",
        package=cobotwire.__version__,
        codec=cobotwire.codec_in_use(),
        port=port,
    )


@cache
def edition_digest(edition: str) -> str:
    """Return the SHA-256 of an edition's table; empty if the table is not stored."""
    try:
        package = getattr(editions.load(edition), "__name__", "")
        return sha256(stored_file(package)[1]).hexdigest()
    except (KeyError, OSError):
        return ""


@cache
def code_digest() -> str:
    """Return the SHA-256 of the modules of the testers; it names the exact code of a run."""
    hashed = sha256()
    for name, module in sorted(_modules(files("cobotwire.conformance"), "")):
        hashed.update(f"{name}\n".encode())
        hashed.update(module.read_bytes().replace(b"\r\n", b"\n"))
    return hashed.hexdigest()


def _modules(folder: Traversable, path: str) -> Iterator[tuple[str, Traversable]]:
    for entry in folder.iterdir():
        name = f"{path}{entry.name}"
        if entry.is_dir() and name not in NO_TESTERS:
            yield from _modules(entry, f"{name}/")
        elif name.endswith(".py"):
            yield name, entry
