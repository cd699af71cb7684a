"""The byte diagram of every message of every edition is aligned and shows each byte once."""

from __future__ import annotations

import re

import pytest

import vectors
from cobotwire_codegen.render.diagram import WIDTH, byte_diagram
from cobotwire_codegen.render.markdown import byte_rows
from strategies import TABLES


@pytest.mark.parametrize("name", sorted(TABLES))
def test_boxes_of_the_diagram_align_and_show_every_byte(name: str) -> None:
    edition = vectors.edition(name)
    for command in edition.commands:
        for variant in (*command.requests, *command.replies):
            rows = list(byte_rows(edition, command, variant))
            lines = byte_diagram(rows).splitlines()
            for above, top, inside, below in zip(*(lines[start::4] for start in range(4))):
                assert len(top) == len(inside) == len(below) <= WIDTH + 1
                assert [m.start() for m in re.finditer("[┌┬┐]", top)] == [
                    m.start() for m in re.finditer("│", inside)
                ]
                assert len(above) <= len(top)
            shown = " ".join(lines[::4]).split()
            assert shown == [position for position, _, _ in rows]


def test_diagram_of_a_reply_labels_each_byte() -> None:
    edition = vectors.edition("mycobot")
    command = next(command for command in edition.commands if command.name == "is_power_on")
    assert byte_diagram(byte_rows(edition, command, command.replies[0])) == (
        "  0-1     2    3    4         5\n"
        "┌───────┬────┬────┬─────────┬────┐\n"
        "│ FE FE │ 03 │ 12 │ powered │ FA │\n"
        "└───────┴────┴────┴─────────┴────┘"
    )
