"""Proposed values reveal mistakes; ``ids`` and ``explain`` help to write a command."""

from __future__ import annotations

import json

import pytest

from cobotwire_codegen.author.describe import describe_command
from cobotwire_codegen.author.propose import typical_values
from cobotwire_codegen.model import Flag, Quantity
from cobotwire_codegen.model.frame import Direction
from cobotwire_codegen.wire import encode_value, encode_variant
from codegen.author import samples
from targets.specs import FILES, edition_of

DIRECTIONS: tuple[Direction, ...] = ("request", "reply")


@pytest.mark.parametrize("name", sorted(FILES))
def test_proposed_values_are_legal_asymmetric_and_not_zero(name: str) -> None:
    edition = edition_of(name)
    words = []
    for command in edition.commands:
        for direction in DIRECTIONS:
            for variant in command.variants(direction):
                values = typical_values(edition, command, variant)
                _, data = encode_variant(command, direction, values)
                assert len(data) <= edition.frame.maximum_data
                for field in variant:
                    if field.const is None and not field.selector:
                        shown = encode_value(field.type, field.name, values[field.name])
                        assert any(shown) or isinstance(field.type, Flag), (command.name, values)
                        one = isinstance(field.type, Quantity) and len(shown) > 1
                        words += [(shown, shown[::-1])] if one else []
    assert [word for word, swapped in words if word == swapped] == []


def test_ids_lists_used_and_free_ids() -> None:
    folder = FILES["sensor"].parent
    text = samples.run(folder, "ids", "sensor.yaml")
    assert text.returncode == 0
    assert "0x29  get_satellites\n" in text.stdout
    assert text.stdout.splitlines()[-1].startswith("free: 0x00..0x1f, 0x2")
    found = json.loads(samples.run(folder, "ids", "sensor.yaml", "--json").stdout)
    assert {"id": 0x29, "commands": ["get_satellites"]} in found["used"]
    free = {id for span in found["free"] for id in range(span["first"], span["last"] + 1)}
    assert sorted(free | {each["id"] for each in found["used"]}) == [*range(256)]
    assert not free & {command.id for command in edition_of("sensor").commands}


def test_positions_after_a_list_count_from_its_end() -> None:
    edition = edition_of("sensor")
    shown = describe_command(edition, edition.by_name["get_satellites"]).splitlines()
    rows = [line.split()[:2] for line in shown if line.startswith(("  5-", "  n+", "  m+"))]
    assert rows == [["5-n", "satellites"], ["n+1-m", "words"], ["m+1", "footer"]]
    assert "  2      LEN                      03..3B" in shown
