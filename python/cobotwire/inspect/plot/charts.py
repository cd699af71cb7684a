"""Draw a series as charts with matplotlib, into a file."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from math import ceil, log10
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cobotwire.capture.file_errors import unusable_file
from cobotwire.inspect.plot.reply_times import ReplyTimes
from cobotwire.inspect.plot.series import Series, Track

# Distinguishable without colour vision (Okabe and Ito); thin lines also differ by their dashes.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
DASHES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (1, 1)))
SETTINGS: Any = {
    "svg.hashsalt": "cobotwire",  # so that the same series gives the same file
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "figure.facecolor": "white",  # readable on a dark page, too
    "savefig.facecolor": "white",
}
WIDTH_INCHES, PANEL_INCHES, DOTS_AN_INCH = 9.0, 1.9, 130
# The approximate number of bars over the width.
BARS = 60

Panel = tuple[str, Callable[[Axes], None]]


def draw(series: Series, path: str, title: str) -> None:
    """Draw the charts of a series; the suffix of the file chooses the format.

    Raises:
        UsageError: the file cannot be written.
    """
    with mpl.rc_context(SETTINGS):
        save(_figure(series, title), path)


def save(figure: Figure, path: str) -> None:
    """Write a figure without a date, so that the same figure gives the same file.

    Raises:
        UsageError: the file cannot be written.
    """
    suffix = Path(path).suffix.lower()
    dated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    part = f"{path}.part"
    try:
        figure.savefig(part, format=suffix[1:], dpi=DOTS_AN_INCH, metadata=dated.get(suffix))
        # In one step, so that a viewer never sees half a picture.
        os.replace(part, path)
    except OSError as error:
        with suppress(OSError):
            os.unlink(part)
        raise unusable_file("output", path, error) from None


def _figure(series: Series, title: str) -> Figure:
    panels = _panels(series)
    size = (WIDTH_INCHES, PANEL_INCHES * len(panels) + 0.6)
    figure = Figure(figsize=size, layout="constrained")
    all_axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (label, fill) in zip(all_axes, panels):
        fill(axes)
        axes.set_ylabel(label)
        if axes.get_legend_handles_labels()[0]:
            axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    all_axes[-1].set_xlim(0, series.end or 1)
    timed = series.axis == "seconds"
    all_axes[-1].set_xlabel("time, s" if timed else "offset in the stream, bytes (no times)")
    figure.align_ylabels(all_axes)
    # A file name or a port may hold what looks like a formula.
    figure.suptitle(title, fontsize=11, parse_math=False)
    return figure


def _panels(series: Series) -> list[Panel]:
    """Return a panel for each kind of data that the series holds; at least one for the frames."""
    timed = series.axis == "seconds"
    joints, coords = series.tracks["joints"], series.tracks["coordinates"]
    panels: list[Panel] = []
    if joints.at:
        names = [f"J{joint + 1}" for joint in range(len(joints.rows[0]))]
        lines = partial(_lines, track=joints, names=dict(enumerate(names)), gaps=timed)
        panels.append(("joints, °", lines))
    for unit, symbol in (("millimetre", "mm"), ("degree", "°")):
        shown = {at: coords.names[at] for at, each in enumerate(coords.units) if each == unit}
        if coords.at and shown:
            lines = partial(_lines, track=coords, names=shown, gaps=timed)
            panels.append((f"end, {symbol}", lines))
    each = "per second" if timed else "per 1000 bytes"
    received = " received" * (series.reply_times is not None)
    panels.append((f"frames{received}\n{each}", lambda axes: _frames(axes, series)))
    if series.noise:
        panels.append((f"noise, bytes\n{each}", lambda axes: _noise(axes, series)))
    times = series.reply_times
    if times is not None and (times.all or times.missing):
        panels.append(("reply time, ms", lambda axes: _reply_times(axes, times)))
    return panels


def _lines(axes: Axes, track: Track, names: Mapping[int, str], gaps: bool) -> None:
    """Draw the numbers of a track that have names, by their index in a row."""
    times, rows = track.with_gaps() if gaps else (track.at, track.rows)
    for index, (at, name) in enumerate(names.items()):
        values = [row[at] for row in rows]
        # A seventh line has the colour of the first, and other dashes.
        style: dict[str, Any] = {
            "color": COLOURS[index % 6],
            "linestyle": DASHES[(index + index // 6) % 6],
            "linewidth": 1.3,
        }
        # A single value would be an invisible line.
        axes.plot(times, values, label=name, marker="." if len(values) < 2 else None, **style)


def _frames(axes: Axes, series: Series) -> None:
    _bars(axes, series, [(at, 1) for at in series.frames], COLOURS[0])


def _noise(axes: Axes, series: Series) -> None:
    _bars(axes, series, series.noise, COLOURS[1])


def _bars(axes: Axes, series: Series, events: Sequence[tuple[float, int]], colour: str) -> None:
    unit = 1.0 if series.axis == "seconds" else 1000.0
    width = bar_width(series.end, unit)
    sums = [0] * max(1, ceil(series.end / width))
    for at, amount in events:
        sums[min(int(at / width), len(sums) - 1)] += amount
    starts = [index * width for index in range(len(sums))]
    heights = [amount * unit / width for amount in sums]
    axes.bar(starts, heights, width=0.92 * width, align="edge", color=colour)
    axes.set_ylim(bottom=0)


def bar_width(end: float, unit: float) -> float:
    """Return a width that gives about ``BARS`` bars: 1, 2 or 5 times a power of ten.

    It is at least a tenth of ``unit``.
    """
    wanted = max(end / BARS, unit / 10)
    power = 10.0 ** ceil(log10(wanted) - 1)
    return float(next(step * power for step in (1, 2, 5, 10) if step * power >= wanted * 0.999))


def _reply_times(axes: Axes, times: ReplyTimes) -> None:
    late = set(times.late)
    timely = [time for time in times.all if time not in late]
    _marks(axes, timely, "in time", marker=".", color=COLOURS[0], s=12)
    _marks(axes, times.late, "late", marker="^", color=COLOURS[1], s=28)
    axes.set_ylim(bottom=0)
    top = axes.get_ylim()[1] / 1000
    lost = [(at, top) for at in times.missing]
    _marks(axes, lost, "no reply", marker="x", color="#000000", s=28)


def _marks(axes: Axes, marks: Sequence[tuple[float, float]], label: str, **style: Any) -> None:
    if marks:
        axes.scatter(
            [at for at, _ in marks], [1000 * took for _, took in marks], label=label, **style
        )
