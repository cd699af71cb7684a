"""Waiting for a reply that is text outside any frame; only silence shows its end."""

from __future__ import annotations

from typing import Any

from cobotwire.errors import ProtocolError
from cobotwire.session import text
from cobotwire.table import TextReply

# Names and passwords of a network have 32 and 63 characters at most.
TEXT_LIMIT = 4096


class TextListener:
    """Finds the text among the noise. What comes in front of its first prefix is none of it."""

    def __init__(self, form: TextReply) -> None:
        self.silence = form.silence_ms / 1000
        self._form = form
        self._prefix = form.prefixes[0].encode("ascii")
        self._heard = b""
        self._last: float | None = None

    @property
    def silent_at(self) -> float | None:
        """When the text is over if no more of it comes; None: it has not begun."""
        return None if self._last is None else self._last + self.silence

    def over(self, now: float) -> bool:
        """Whether there is a text, and it has been silent for long enough."""
        return self.silent_at is not None and now >= self.silent_at

    def hear(self, data: bytes, now: float) -> None:
        """Take bytes that belong to no frame."""
        if not data:
            return
        self._heard += data
        if self._last is None:
            start = self._heard.find(self._prefix)
            if start < 0:
                # The prefix may have begun in the last bytes.
                self._heard = self._heard[-len(self._prefix) :]
                return
            self._heard = self._heard[start:]
        self._last = now
        self._heard = self._heard[: TEXT_LIMIT + 1]

    def read(self) -> dict[str, Any]:
        """The fields.

        Raises:
            ProtocolError: the text is not what it should be.
        """
        if len(self._heard) > TEXT_LIMIT:
            detail = f"the text is longer than {TEXT_LIMIT} bytes"
            raise ProtocolError("bad-text", TEXT_LIMIT, self._heard[:64], detail)
        return dict(text.read(self._form, self._heard))
