"""The byte diagram of every message of every edition is aligned and shows each byte once."""

from __future__ import annotations

import re

import pytest

import vectors
from cobotwire_codegen.model.frame import Direction
from cobotwire_codegen.render.byte_table import byte_rows
from cobotwire_codegen.render.diagram import WIDTH, byte_diagram
from strategies import TABLES

DIRECTIONS: tuple[Direction, ...] = ("request", "reply")


@pytest.mark.parametrize("name", sorted(TABLES))
def test_boxes_of_the_diagram_align_and_show_every_byte(name: str) -> None:
    edition = vectors.edition(name)
    for command in edition.commands:
        for direction in DIRECTIONS:
            for variant in command.variants(direction):
                rows = list(byte_rows(edition, command, direction, variant))
                lines = byte_diagram(rows).splitlines()
                for above, top, inside, below in zip(*(lines[start::4] for start in range(4))):
                    assert len(top) == len(inside) == len(below) <= WIDTH + 1
                    assert [m.start() for m in re.finditer("[┌┬┐]", top)] == [
                        m.start() for m in re.finditer("│", inside)
                    ]
                    assert len(above) <= len(top)
                shown = " ".join(lines[::4]).split()
                assert shown == [position for position, _, _ in rows]
