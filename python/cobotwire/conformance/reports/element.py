"""HTML and SVG out of nested calls; text is escaped by the standard library."""

from __future__ import annotations

from xml.etree import ElementTree

Child = ElementTree.Element | str


def element(tag: str, *children: Child, **attributes: str | float) -> ElementTree.Element:
    """An element. ``class_`` is the attribute class; underscores within become hyphens."""
    named = {name.rstrip("_").replace("_", "-"): str(v) for name, v in attributes.items()}
    made = ElementTree.Element(tag, named)
    last: ElementTree.Element | None = None
    for child in children:
        if not isinstance(child, str):
            made.append(child)
            last = child
        elif last is None:
            made.text = (made.text or "") + child
        else:
            last.tail = (last.tail or "") + child
    return made


def page(*children: Child, lang: str = "en") -> str:
    """A whole document."""
    text = ElementTree.tostring(element("html", *children, lang=lang), "unicode", method="html")
    return f"<!doctype html>\n{text}\n"
