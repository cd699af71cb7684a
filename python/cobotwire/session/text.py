"""Text outside any frame: ``prefix field prefix field suffix``, in ASCII."""

from __future__ import annotations

from collections.abc import Mapping

from cobotwire.errors import ProtocolError, UsageError
from cobotwire.table import TextReply, TextRequest

Text = TextReply | TextRequest


def spell(form: Text, values: Mapping[str, str]) -> bytes:
    """The bytes of a text.

    Raises:
        UsageError: a value is no ASCII text, or holds what would make the text read otherwise.
    """
    for name in form.fields:
        value = values[name]
        if not isinstance(value, str) or not value.isascii() or not value.isprintable():
            raise UsageError(name, value, "printable ASCII text")
    pieces = (prefix + values[name] for prefix, name in zip(form.prefixes, form.fields))
    data = ("".join(pieces) + form.suffix).encode("ascii")
    try:
        unharmed = read(form, data) == {name: values[name] for name in form.fields}
    except ProtocolError:
        unharmed = False
    if not unharmed:
        words = " or ".join(repr(word) for word in (*form.prefixes[1:], form.suffix) if word)
        given = tuple(values[name] for name in form.fields)
        raise UsageError(", ".join(form.fields), given, f"text without {words} inside")
    return data


def read(form: Text, data: bytes) -> dict[str, str]:
    """The fields of a text. They may contain spaces; a line end behind the last is dropped.

    Raises:
        ProtocolError: it is no ASCII text, it does not start or end as it should, or a prefix
            stands in it more than once, so that it can be read in two ways.
    """
    try:
        text = data.decode("ascii").rstrip("\r\n")
    except UnicodeDecodeError as error:
        raise ProtocolError("bad-text", error.start, data, "the text is no ASCII") from None
    if not text.startswith(form.prefixes[0]):
        raise ProtocolError("bad-text", 0, data, f"the text starts with {form.prefixes[0]!r}")
    if not text.endswith(form.suffix) or len(text) < len(form.prefixes[0] + form.suffix):
        raise ProtocolError("bad-text", len(data), data, f"the text ends with {form.suffix!r}")
    rest = text[len(form.prefixes[0]) : len(text) - len(form.suffix)]
    values = []
    for prefix in form.prefixes[1:]:
        if rest.count(prefix) != 1:
            detail = f"{prefix!r} stands {rest.count(prefix)} times in the text, not once"
            raise ProtocolError("bad-text", len(text) - len(rest), data, detail)
        value, rest = rest.split(prefix)
        values.append(value)
    return dict(zip(form.fields, (*values, rest)))
