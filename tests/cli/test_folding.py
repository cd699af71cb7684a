"""Break long lines on a terminal."""

from __future__ import annotations

import click
import pytest

from cobotwire.cli.shared import output
from cobotwire.cli.shared.hex_colours import frame_colours
from cobotwire.editions.mycobot import TABLE

FRAME = bytes.fromhex("FE FE 0F 2A 25 2E FF C3 FF C3 FF C3 22 B5 FF 7D 00 FA")


@pytest.mark.parametrize("columns", [16, 20, 40, 80])
@pytest.mark.parametrize("line", ["noise   {}   bad", "  0.001 > {}", "{} {}", "one: {}  two"])
def test_hex_is_broken_between_bytes_and_loses_nothing(
    monkeypatch: pytest.MonkeyPatch, columns: int, line: str
) -> None:
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", str(columns))
    text = line.format(*[frame_colours(TABLE.frame)(FRAME * 3)] * 2)
    folded = output.fold(f"{text}\nnext")
    rows = click.unstyle(folded).split("\n")
    assert max(map(len, rows)) <= columns
    assert " ".join(folded.split()) == " ".join(f"{text} next".split())
    assert len(rows) <= 2 + len(click.unstyle(text)) // (columns // 2 - 3)
