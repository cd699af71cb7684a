"""Draw the pictures of ``docs/answers.md`` from an archive of the example capture.

python docs/answers/draw.py archive/ docs/plots/
"""

from __future__ import annotations

import sys
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import matplotlib as mpl
import polars as pl
from matplotlib.dates import DateFormatter, DayLocator
from matplotlib.figure import Figure

# Colours that can be distinguished without colour vision (Okabe and Ito's palette).
COLOURS = ("#0072B2", "#D55E00", "#E69F00", "#009E73", "#CC79A7", "#56B4E9")
SETTINGS: Any = {
    "svg.hashsalt": "cobotwire",  # the same archive gives the same file
    "svg.fonttype": "none",
    "font.family": "DejaVu Sans",
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "figure.facecolor": "white",  # readable on a dark page
    "savefig.facecolor": "white",
}


def temperatures(archive: Path) -> Figure:
    """Plot the temperature of each joint over time, and the reboots."""
    table = pl.read_parquet(archive / "get_servo_temps.reply.parquet").sort("time")
    figure, axes = _canvas("Temperatures of the joints; the line marks a reboot")
    for joint, colour in enumerate(COLOURS, 1):
        # Only rows where the temperature changes are drawn; the others add no corner to the curve.
        column = pl.col(f"j{joint}")
        corners = table.filter((column.diff() != 0).fill_null(True) | (column.diff(-1) != 0))
        axes.plot(corners["time"], corners[f"j{joint}"], color=colour, label=f"joint {joint}")
    for time in reboots(archive):
        axes.axvline(time, color="#444444", linestyle="--", linewidth=1)
    axes.xaxis.set_major_locator(DayLocator())
    axes.xaxis.set_major_formatter(DateFormatter("%a %d %b", tz=UTC))
    axes.set_ylabel("degrees Celsius")
    axes.legend(frameon=False, loc="upper left", bbox_to_anchor=(1, 1))
    return figure


def reboots(archive: Path) -> list[datetime]:
    """Return when the count of starts rose."""
    counts = pl.read_parquet(archive / "get_reboot_count.reply.parquet").sort("time")
    return counts.filter(pl.col("reboots").diff() > 0)["time"].to_list()


def reply_times(archive: Path) -> Figure:
    """Plot the share of the replies to get_angles within a time, for each day."""
    requests, replies = [
        pl.read_parquet(archive / f"get_angles.{message}.parquet", columns=["time"])
        for message in ("request", "reply")
    ]
    joined = replies.join_asof(requests.with_columns(sent="time"), on="time").with_columns(
        ms=(pl.col("time") - pl.col("sent")).dt.total_nanoseconds() / 1e6,
        day=pl.col("time").dt.date(),
    )
    figure, axes = _canvas("Replies to get_angles")
    for ((day,), rows), colour in zip(joined.group_by("day", maintain_order=True), COLOURS):
        shares = [100 * (number + 1) / len(rows) for number in range(len(rows))]
        axes.plot(rows["ms"].sort(), shares, color=colour, label=f"{day:%a %d %b}")
    axes.set_xlabel("time from request to reply, milliseconds")
    axes.set_ylabel("percent of the replies")
    axes.set_xlim(left=0)
    axes.legend(frameon=False, loc="lower right")
    return figure


def _canvas(title: str) -> tuple[Figure, Any]:
    figure = Figure(figsize=(7, 3.2), layout="constrained")
    axes = figure.subplots()
    axes.set_title(title, loc="left", fontsize=10)
    return figure, axes


def main(archive: Path, folder: Path) -> None:
    """Write the pictures."""
    with mpl.rc_context(SETTINGS):
        for name, figure in (
            ("answers-temperatures.svg", temperatures(archive)),
            ("answers-reply-times.svg", reply_times(archive)),
        ):
            figure.savefig(folder / name, metadata={"Date": None})


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
