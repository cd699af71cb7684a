"""Check the byte table of ``cobotwire commands NAME`` for every frame format."""

from __future__ import annotations

import pytest

from cobotwire.cli.commands import byte_table
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.table import Check, FrameFormat
from in_process import cobotwire
from json_tables import CRC16_MODBUS, SUM_OF_DATA


def rows(frame: FrameFormat) -> list[tuple[object, ...]]:
    command = TABLE.command("get_encoder")
    grid = byte_table(frame, command, "request", command.request[0])
    return list(zip(*[list(column.cells) for column in grid.columns[:3]]))


def test_motion_of_the_client_is_described() -> None:
    text = cobotwire("commands", "go_home").stdout
    assert text.startswith("`cobotwire call URL go_home` runs it; it is a method of the client.")
    assert "timeout: seconds to wait at most" in text


def test_byte_table_shows_the_footer() -> None:
    assert rows(TABLE.frame) == [
        ("0-1", "header", "FE FE"),
        ("2", "LEN", "03"),
        ("3", "CMD", "3B"),
        ("4", "joint", "1..6"),
        ("5", "footer", "FA"),
    ]


@pytest.mark.parametrize(
    ("check", "place", "length"), [(CRC16_MODBUS, "6-7", 4), (SUM_OF_DATA, "6", 3)]
)
def test_byte_table_shows_address_and_check(check: Check, place: str, length: int) -> None:
    frame = TABLE.frame._replace(check=check, footer=b"", addresses=(1, 2))
    assert rows(frame) == [
        ("0-1", "header", "FE FE"),
        ("2", "address", "01, 02"),
        ("3", "LEN", f"{length:02X}"),
        ("4", "CMD", "3B"),
        ("5", "joint", "1..6"),
        (place, check.algorithm, ""),
    ]
