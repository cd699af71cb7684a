"""Text outside any frame: ``word {field} word {field}``."""

from __future__ import annotations

import re

from cobotwire_codegen.model import Text
from cobotwire_codegen.reader import Reader

_PLACEHOLDER = re.compile(r"\{(\w+)\}")


def build_text(outer: Reader, key: str) -> Text | None:
    """The text under a key of a command, or None."""
    node = outer.node(key)
    if node is None:
        return None
    reader = Reader(node, f"the {key} of {outer.what}", outer.problems)
    pieces = _PLACEHOLDER.split(reader.text("text"))
    docs: dict[str, str] = {}
    for item in reader.items("fields"):
        inner = Reader(item, f"a field of {reader.what}", outer.problems)
        docs[inner.text("name")] = inner.text("doc")
        inner.done()
    reply = key == "reply_text"
    prefixes, suffix = pieces[0:-1:2], pieces[-1]
    # A reply ends with a field and by silence; between two fields there must be something to tell
    # where one ends.
    if pieces[1::2] != list(docs) or (reply and suffix) or not all(prefixes[0 if reply else 1 :]):
        message = "the text must be `word {field}` in turn, with the fields as listed"
        reader.problem("bad-text", message)
    text = Text(
        node.place,
        reader.text("class") if reply else "",
        tuple(prefixes),
        tuple(docs.items()),
        suffix,
        reader.positive("silence_ms") if reply else 0,
    )
    reader.done()
    return text
