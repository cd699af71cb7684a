"""Builds the messages that are text outside any frame: ``word {field} word {field}``."""

from __future__ import annotations

import re

from cobotwire_codegen import language
from cobotwire_codegen.language.records import Key
from cobotwire_codegen.load import Node
from cobotwire_codegen.model import Text
from cobotwire_codegen.reader import Reader

_PLACEHOLDER = re.compile(r"\{(\w+)\}")


def build_request_text(outer: Reader, key: Key[Node | None]) -> Text | None:
    """Return the text that follows a request, or None."""
    node = outer.get(key)
    if node is None:
        return None
    spec = language.RequestText
    reader = Reader(node, spec, f"the {key.name} of {outer.what}", outer.problems)
    return _build(reader, "", 0, reply=False)


def build_reply_text(outer: Reader, key: Key[Node | None]) -> Text | None:
    """Return the text that is a command's reply, or None."""
    node = outer.get(key)
    if node is None:
        return None
    spec = language.ReplyText
    reader = Reader(node, spec, f"the {key.name} of {outer.what}", outer.problems)
    return _build(reader, reader.get(spec.class_), reader.get(spec.silence_ms), reply=True)


def _build(reader: Reader, class_name: str, silence_ms: int, *, reply: bool) -> Text:
    pieces = _PLACEHOLDER.split(reader.get(language.RequestText.text))
    docs: dict[str, str] = {}
    for item in reader.get(language.RequestText.fields):
        inner = Reader(item, language.TextField, f"a field of {reader.what}", reader.problems)
        docs[inner.get(language.TextField.name)] = inner.get(language.TextField.doc)
    prefixes, suffix = pieces[0:-1:2], pieces[-1]
    # A reply ends with a field, then silence. Between two fields there must be a word, or a reader
    # could not tell where the first one ends.
    if pieces[1::2] != list(docs) or (reply and suffix) or not all(prefixes[0 if reply else 1 :]):
        message = "the text must alternate words and `{field}`, with the fields in listed order"
        reader.problem("bad-text", message)
    return Text(reader.place, class_name, tuple(prefixes), tuple(docs.items()), suffix, silence_ms)
