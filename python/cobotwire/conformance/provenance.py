"""Where a report comes from: the edition, the test suite and the machine of the run."""

from __future__ import annotations

import platform
from functools import cache
from hashlib import sha256

import cobotwire
from cobotwire import editions
from cobotwire.conformance.catalogue import VERSION, code_digest
from cobotwire.conformance.report import Environment, Report
from cobotwire.protocol.loading import stored_file


def identify(report: Report, edition: str, *, port: str = "") -> None:
    """Write into a report what it needs to be understood, and repeated, elsewhere.

    Args:
        report: the report.
        edition: the name or package of its edition, as ``editions.load`` takes it.
        port: what connects the tester with the subject.
    """
    report.edition_digest = edition_digest(edition)
    report.catalogue = f"{VERSION}"
    report.code_digest = code_digest()
    report.environment = environment(port)


@cache
def edition_digest(edition: str) -> str:
    """Return the SHA-256 of an edition's table; empty if it is not stored as such."""
    try:
        package = getattr(editions.load(edition), "__name__", "")
        return sha256(stored_file(package)[1]).hexdigest()
    except (KeyError, OSError):
        return ""


def environment(port: str = "") -> Environment:
    """Return the machine and the programs of this run."""
    return Environment(
        host=platform.node(),
        system=platform.platform(),
        python=f"{platform.python_implementation()} {platform.python_version()}",
        package=cobotwire.__version__,
        codec=cobotwire.codec_in_use(),
        port=port,
    )
