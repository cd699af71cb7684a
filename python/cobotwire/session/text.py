"""Text outside any frame: ``prefix field prefix field suffix``, in ASCII."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cobotwire.protocol.error_texts import error_text
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import TextReply, TextRequest

Text = TextReply | TextRequest

# Names and passwords of a network have at most 32 and 63 characters.
TEXT_LIMIT = 4096


def encode(variant: Text, values: Mapping[str, str]) -> bytes:
    """Return the bytes of a text.

    Raises:
        UsageError: a value is not printable ASCII, or would be decoded differently.
    """
    for name in variant.fields:
        value = values[name]
        if not isinstance(value, str) or not value.isascii() or not value.isprintable():
            raise UsageError(name, value, error_text("printable"))
    labelled = (prefix + values[name] for prefix, name in zip(variant.prefixes, variant.fields))
    data = ("".join(labelled) + variant.suffix).encode("ascii")
    try:
        unambiguous = decode(variant, data) == {name: values[name] for name in variant.fields}
    except ProtocolError:
        unambiguous = False
    if not unambiguous:
        words = error_text("or").join(
            [repr(word) for word in (*variant.prefixes[1:], variant.suffix) if word]
        )
        given = tuple(values[name] for name in variant.fields)
        allowed = error_text("unambiguous", words=words)
        raise UsageError(", ".join(variant.fields), given, allowed)
    return data


def decode(variant: Text, data: bytes) -> dict[str, str]:
    """Return the fields of a text by name. They may contain spaces; a final line end is dropped.

    Raises:
        ProtocolError: the text is not ASCII, lacks its start or end, or holds a prefix more than
            once, so that it has two meanings.
    """
    try:
        text = data.decode("ascii").rstrip("\r\n")
    except UnicodeDecodeError as error:
        detail = error_text("text-not-ascii")
        raise ProtocolError("bad-text", error.start, data, detail) from None
    if not text.startswith(variant.prefixes[0]):
        detail = error_text("text-start", prefix=repr(variant.prefixes[0]))
        raise ProtocolError("bad-text", 0, data, detail)
    if not text.endswith(variant.suffix) or len(text) < len(variant.prefixes[0] + variant.suffix):
        detail = error_text("text-end", suffix=repr(variant.suffix))
        raise ProtocolError("bad-text", len(data), data, detail)
    rest = text[len(variant.prefixes[0]) : len(text) - len(variant.suffix)]
    values = []
    for prefix in variant.prefixes[1:]:
        if rest.count(prefix) != 1:
            detail = error_text("text-prefix", prefix=repr(prefix), count=rest.count(prefix))
            raise ProtocolError("bad-text", len(text) - len(rest), data, detail)
        value, rest = rest.split(prefix)
        values.append(value)
    return dict(zip(variant.fields, (*values, rest)))


class TextCollector:
    """Collects a text reply from noise; only silence shows its end.

    Bytes that come before its first prefix do not belong to it.
    """

    def __init__(self, variant: TextReply) -> None:
        self.silence = variant.silence_ms / 1000
        self._variant = variant
        self._prefix = variant.prefixes[0].encode("ascii")
        self._data = b""
        self._last: float | None = None

    @property
    def ends_at(self) -> float | None:
        """The second at which the text ends unless more of it comes; None: it has not begun."""
        return None if self._last is None else self._last + self.silence

    def is_over(self, now: float) -> bool:
        """Return whether a text has begun, and has been silent for long enough."""
        return self._last is not None and now >= self._last + self.silence

    def add(self, data: bytes, now: float) -> None:
        """Take bytes that belong to no frame."""
        if not data:
            return
        self._data += data
        if self._last is None:
            start = self._data.find(self._prefix)
            if start < 0:
                # The prefix may have begun in the last bytes.
                self._data = self._data[-len(self._prefix) :]
                return
            self._data = self._data[start:]
        self._last = now
        self._data = self._data[: TEXT_LIMIT + 1]

    def decode(self) -> dict[str, Any]:
        """Return the fields of the text by name.

        Raises:
            ProtocolError: the text is longer than allowed, or has another form.
        """
        if len(self._data) > TEXT_LIMIT:
            detail = error_text("text-length", most=TEXT_LIMIT)
            raise ProtocolError("bad-text", TEXT_LIMIT, self._data[:64], detail)
        return dict(decode(self._variant, self._data))
