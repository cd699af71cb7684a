"""What a driver needs of a link."""

from __future__ import annotations

from typing import Protocol, runtime_checkable


@runtime_checkable
class Transport(Protocol):
    """An open link."""

    @property
    def url(self) -> str:
        """What was opened, for messages."""
        ...

    def write(self, data: bytes) -> None:
        """Send all of ``data``.

        Raises:
            LinkError: the link is gone, or does not take the bytes.
        """
        ...

    def read(self, timeout: float) -> bytes:
        """What has come, as soon as there is something; empty after ``timeout`` seconds.

        Raises:
            LinkError: the link is gone.
        """
        ...

    def close(self) -> None:
        """Give the link back. Closing twice is harmless."""
        ...
