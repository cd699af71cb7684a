"""Where an edition's spec defines each command; loaded only when a report cites it."""

from __future__ import annotations

from cobotwire import editions
from cobotwire.protocol.loading import load_sources


def spec_lines(edition: str) -> dict[str, str]:
    """Return where the spec defines each command; empty if the edition does not state it."""
    package = editions.load(edition)
    found = load_sources(getattr(package, "__name__", ""))
    return {command: each["place"] for command, each in found.items()}
