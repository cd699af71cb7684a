"""Where an edition's spec says each command; loaded only when a report cites it."""

from __future__ import annotations

from importlib import import_module

from cobotwire import editions


def places_of(edition: str) -> dict[str, str]:
    """Where the spec says each command; none for an edition that does not tell."""
    package = editions.load(edition)
    name = getattr(package, "__name__", "")
    try:
        found = import_module(f"{name}.table.places").PLACES
    except ImportError:
        return {}
    return dict(found)
