"""Build HTML and SVG from nested calls; text is made printable and escaped."""

from __future__ import annotations

from xml.etree import ElementTree

from cobotwire.protocol.printable import printable

Child = ElementTree.Element | str


def element(tag: str, *children: Child, **attributes: str | float) -> ElementTree.Element:
    """Return an element. ``class_`` is the attribute class; inner underscores become hyphens."""
    named = {
        name.rstrip("_").replace("_", "-"): printable(str(v)) for name, v in attributes.items()
    }
    made = ElementTree.Element(tag, named)
    last: ElementTree.Element | None = None
    for child in children:
        if not isinstance(child, str):
            made.append(child)
            last = child
            continue
        # Style sheets and scripts are files of this package.
        text = child if tag in ("style", "script") else printable(child)
        if last is None:
            made.text = (made.text or "") + text
        else:
            last.tail = (last.tail or "") + text
    return made


def page(*children: Child, lang: str = "en") -> str:
    """Return a document as text."""
    text = ElementTree.tostring(element("html", *children, lang=lang), "unicode", method="html")
    return f"<!doctype html>\n{text}\n"
