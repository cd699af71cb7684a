"""Compares texts outside any frame: replies that end with silence, and texts after requests."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen.diff import prose, words
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.match import renamed
from cobotwire_codegen.model import Text


def text_changes(where: str, part: str, old: Text | None, new: Text | None) -> Iterator[Finding]:
    """Compare one text of a command; ``part`` says whether its fields are arguments or results."""
    if old is None or new is None:
        if old is not new:
            yield finding("text-changed", where, words.template(old), words.template(new))
        return
    names = [[name for name, _ in side.fields] for side in (old, new)]
    changed = renamed(*names)
    if changed is None or (old.prefixes, old.suffix) != (new.prefixes, new.suffix):
        yield finding("text-changed", where, words.template(old), words.template(new))
    for before, after in (changed or {}).items():
        yield finding(f"{part}-renamed", f"{where}/{after}", before, after)
    if old.class_name != new.class_name:
        yield finding("class-renamed", where, old.class_name, new.class_name)
    if old.silence_ms != new.silence_ms:
        yield finding("silence-changed", where, old.silence_ms, new.silence_ms)
    docs = dict(new.fields)
    for name, doc in old.fields:
        after = (changed or {}).get(name, name)
        yield from prose.doc(f"{where}/{after}", doc, docs.get(after, doc))
