"""Read the screen that ``cobotwire sim`` shows: lines of traffic, and one table below them."""

from __future__ import annotations

import re

import pytest

from cobotwire import MyCobot
from terminal import Terminal

TITLE = "s of simulated time"


@pytest.mark.parametrize(("columns", "lines"), [(110, 45), (80, 24), (60, 12)])
def test_sim_screen_holds_every_line_of_traffic_above_one_whole_table(
    columns: int, lines: int
) -> None:
    with Terminal("sim", columns=columns, lines=lines) as terminal:
        terminal.until(lambda: "└" in terminal.text())
        url = terminal.rows()[0]
        with MyCobot(url, timeout=5.0) as arm:
            arm.power_on()
            arm.send_angles([45, 10, 0, 0, 0, 0], 100)
            for joint in range(1, 7):
                assert arm.get_encoder(joint)
                shown = f"get_encoder(joint={joint})"
                terminal.until(lambda shown=shown: shown in terminal.text())  # type: ignore[misc]
                # Wait until the table is drawn again, below the line.
                terminal.until(lambda: "└" in terminal.text().rpartition("get_encoder")[2])
        terminal.until(lambda: "j1=45" in terminal.text())
        terminal.press(b"\x03")
        assert terminal.finish() == 0
        assert terminal.has_cursor
    rows = [row for row in terminal.rows() if row]
    assert sum(TITLE in row for row in rows) == 1, "\n".join(rows)
    start = next(index for index, row in enumerate(rows) if TITLE in row)
    traffic, table = "".join("".join(rows[:start]).split()), rows[start + 1 :]
    order = re.findall(r"received\S*?([a-z_]+)\(", traffic)
    assert order == ["power_on", "send_angles", *["get_encoder"] * 6]
    assert traffic.count("replyFEFE04") == 6
    assert (table[0][0], table[-1][0]) == ("┌", "└"), "\n".join(rows)
    assert all(row.startswith("│") for row in table[1:-1]), "\n".join(rows)
    for label in ("joints, degrees", "powered", "moving"):
        assert sum(label in row for row in table) == 1
