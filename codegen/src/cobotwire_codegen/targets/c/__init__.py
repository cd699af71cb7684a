"""Writes C99 for firmware and hosts: a header and a source for each edition."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from cobotwire_codegen import lower
from cobotwire_codegen.model import Edition, Enum, Quantity
from cobotwire_codegen.render import Files, environment
from cobotwire_codegen.targets.c import names
from cobotwire_codegen.targets.c.messages import Message, quantities
from cobotwire_codegen.targets.c.tables import Tables
from cobotwire_codegen.targets.support import require_plain


def render_c(edition: Edition, templates: Path | None = None) -> Files:
    """Return the edition's header and source; ``templates`` replace the shipped ones."""
    require_plain(edition, "C")
    jinja = environment(templates)
    jinja.filters.update(comment=names.comment, c_string=names.string, rows=names.rows)
    jinja.filters.update(integer=names.integer)
    tables = Tables(edition)
    common = {
        "edition": edition,
        "p": edition.name,
        "P": edition.name.upper(),
        "tables": tables,
        "enums": list(_enums(tables.messages)),
        "scaled": list(_scaled(tables.messages)),
        "maximum_length": lower.maximum_length(edition),
        "overhead": overhead(edition),
    }
    return {
        PurePosixPath(f"{edition.name}.{end}"): jinja.get_template(f"c/{name}.j2").render(common)
        for end, name in (("h", "header.h"), ("c", "source.c"))
    }


def overhead(edition: Edition) -> int:
    """Return the number of bytes before a frame's command id."""
    return len(edition.frame.header) + bool(edition.frame.addresses) + 1


def _enums(found: list[Message]) -> Iterator[Enum]:
    """Return the enums in messages, each once."""
    types = (t for m in found for member in m.members for _, t in lower.cases(member.field))
    yield from dict.fromkeys(type for type in types if isinstance(type, Enum))


def _scaled(found: list[Message]) -> Iterator[Quantity]:
    """Return the scaled quantities, each name once; quantities of one name differ only in range."""
    seen: set[str] = set()
    for message in found:
        for member in message.members:
            for _, quantity in quantities(member.field):
                if quantity.scale != 1 and quantity.name not in seen:
                    seen.add(quantity.name)
                    yield quantity
