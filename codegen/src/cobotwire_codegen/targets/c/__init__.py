"""Writes C99 for firmware and hosts: a header and a source for each edition."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from cobotwire_codegen import lower
from cobotwire_codegen.model import Bits, Edition, Enum, Listed, Quantity, Type
from cobotwire_codegen.render import Files, environment
from cobotwire_codegen.targets.c import names
from cobotwire_codegen.targets.c.frame import FrameFacts
from cobotwire_codegen.targets.c.groups import groups
from cobotwire_codegen.targets.c.messages import Message, quantities
from cobotwire_codegen.targets.c.tables import Tables


def render_c(edition: Edition, templates: Path | None = None) -> Files:
    """Return the edition's header and source; ``templates`` replace the shipped ones."""
    jinja = environment(templates)
    jinja.filters.update(comment=names.comment, c_string=names.string, rows=names.rows)
    jinja.filters.update(integer=names.integer)
    tables = Tables(edition)
    common = {
        "edition": edition,
        "p": edition.name,
        "P": edition.name.upper(),
        "f": FrameFacts(edition),
        "tables": tables,
        "enums": list(_enums(tables.messages)),
        "groups": list(groups(edition.name, tables.messages)),
        "scaled": list(_scaled(tables.messages)),
        "id_format": f"%0{2 * edition.frame.command_number.width}X",
        "element_bits": 16 if tables.most_elements > 255 else 8,
    }
    return {
        PurePosixPath(f"{edition.name}.{end}"): jinja.get_template(f"c/{name}.j2").render(common)
        for end, name in (("h", "header.h"), ("c", "source.c"))
    }


def _enums(found: list[Message]) -> Iterator[Enum]:
    """Return the enums in messages, each once. An enum of bits has another wire type."""
    seen: set[str] = set()
    for message in found:
        for member in message.members:
            for _, type in lower.cases(member.field):
                for enum in _enums_in(type):
                    if enum.name not in seen:
                        seen.add(enum.name)
                        yield enum


def _enums_in(type: Type) -> Iterator[Enum]:
    parts = [part for _, part in type.items] if isinstance(type, Bits) else [type]
    for part in parts:
        inner = part.of if isinstance(part, Listed) else part
        if isinstance(inner, Enum):
            yield inner


def _scaled(found: list[Message]) -> Iterator[Quantity]:
    """Return the scaled quantities, each name once; quantities of one name differ only in range."""
    seen: set[str] = set()
    for message in found:
        for member in message.members:
            for _, quantity in quantities(member.field):
                if quantity.scale != 1 and quantity.name not in seen:
                    seen.add(quantity.name)
                    yield quantity
