"""Lays out Python text as ruff does, so that generated files need no formatter."""

from __future__ import annotations

import re
import textwrap

WIDTH = 100


def laid_out(head: str, parts: list[str], tail: str, indent: int) -> str:
    """Return ``head parts tail`` on one line, on three, or with a line for each part."""
    joined = ", ".join(parts)
    margin = " " * indent
    if indent + len(head) + len(joined) + len(tail) <= WIDTH:
        return f"{head}{joined}{tail}"
    if indent + 4 + len(joined) <= WIDTH and "\n" not in joined:
        return f"{head}\n{margin}    {joined}\n{margin}{tail}"
    lines = "".join(f"{margin}    {part},\n" for part in parts)
    return f"{head}\n{lines}{margin}{tail}"


def import_line(module: str, names: list[str]) -> str:
    """Return the import of names from a module, a line for each if they do not fit on one."""
    flat = f"from {module} import {', '.join(names)}"
    if len(flat) <= WIDTH:
        return flat
    return f"from {module} import (\n" + "".join(f"    {name},\n" for name in names) + ")"


def escaped(text: str) -> str:
    """Return text escaped for a docstring, even right before the closing quotes."""
    text = text.replace("\\", "\\\\")
    # Escape each quote that precedes another quote or the end, so that no three remain in a row.
    return re.sub(r'"(?="|\Z)', r'\\"', text)


def docstring(text: str, indent: int) -> str:
    """Return a docstring of one paragraph, on one line if it fits."""
    text = escaped(text)
    flat = f'{" " * indent}"""{text}"""'
    if len(flat) <= WIDTH:
        return flat
    opened = _filled(f'"""{text}', indent, 0)
    return f'{opened}\n{" " * indent}"""'


def wrapped(text: str, indent: int, hanging: int = 0) -> str:
    """Return a paragraph of a docstring; further lines are indented ``hanging`` deeper."""
    return _filled(escaped(text), indent, hanging)


def _filled(text: str, indent: int, hanging: int) -> str:
    return textwrap.fill(
        text,
        WIDTH,
        initial_indent=" " * indent,
        subsequent_indent=" " * (indent + hanging),
        break_long_words=False,
        break_on_hyphens=False,
    )


def capitalize_first(text: str) -> str:
    """Return a sentence with its first letter in upper case, the other letters unchanged."""
    return text[:1].upper() + text[1:]


def oneline(text: str) -> str:
    """Return a method's head as a signature on one line."""
    flat = " ".join(text.split()).replace("( ", "(").replace(", )", ")").replace(" )", ")")
    return (
        flat.removeprefix("def ").removesuffix(":").replace("(self, ", "(").replace("(self)", "()")
    )
