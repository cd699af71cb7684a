"""Replies outside any frame: ASCII text whose end shows only by silence."""

from __future__ import annotations

from collections.abc import Mapping

from cobotwire.errors import ProtocolError
from cobotwire.table import TextReply


def spell(reply: TextReply, values: Mapping[str, str]) -> bytes:
    """The bytes of a text reply."""
    pieces = (prefix + values[name] for prefix, name in zip(reply.prefixes, reply.fields))
    return "".join(pieces).encode("ascii")


def read(reply: TextReply, data: bytes) -> dict[str, str]:
    """The fields of a text reply. They may contain spaces; a line end behind the last is dropped.

    Raises:
        ProtocolError: it is no ASCII text, it does not start as it should, or a prefix stands in it
            more than once, so that it can be read in two ways.
    """
    try:
        text = data.decode("ascii").rstrip("\r\n")
    except UnicodeDecodeError as error:
        raise ProtocolError("bad-text", error.start, data, "the reply is no ASCII text") from None
    if not text.startswith(reply.prefixes[0]):
        raise ProtocolError("bad-text", 0, data, f"the reply starts with {reply.prefixes[0]!r}")
    rest = text[len(reply.prefixes[0]) :]
    values = []
    for prefix in reply.prefixes[1:]:
        if rest.count(prefix) != 1:
            detail = f"{prefix!r} stands {rest.count(prefix)} times in the reply, not once"
            raise ProtocolError("bad-text", len(text) - len(rest), data, detail)
        value, rest = rest.split(prefix)
        values.append(value)
    return dict(zip(reply.fields, (*values, rest)))
