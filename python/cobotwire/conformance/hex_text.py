"""Show bytes as hex."""

from __future__ import annotations


def shown(data: bytes, most: int = 40) -> str:
    """Return bytes as hex, shortened if they are many."""
    text = data[:most].hex(" ").upper()
    return text if len(data) <= most else f"{text} ... ({len(data)} bytes)"
