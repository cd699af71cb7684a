"""A series as a picture. The only importer of matplotlib; without a window (Agg)."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from math import ceil, log10
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cobotwire.errors import UsageError
from cobotwire.plot.replies import Replies
from cobotwire.plot.series import Series, Track

SUFFIXES = (".png", ".svg", ".pdf")
# Told apart without colour vision too (Okabe and Ito); and by their dashes where lines are thin.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
DASHES = ("-", "--", "-.", ":", (0, (5, 1)), (0, (1, 1)))
SETTINGS: Any = {
    "svg.hashsalt": "cobotwire",  # the same series gives the same file
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "figure.facecolor": "white",  # to be read on a dark page, too
    "savefig.facecolor": "white",
}
WIDTH_INCHES, PANEL_INCHES, DOTS_AN_INCH = 9.0, 1.9, 130
# About so many bars over the width.
BARS = 60

Panel = tuple[str, Callable[[Axes], None]]


def draw(series: Series, path: str, title: str) -> None:
    """Write the picture; the file's suffix says of which kind.

    Raises:
        UsageError: the suffix is none, or the file cannot be written.
    """
    check_suffix(path)
    with mpl.rc_context(SETTINGS):
        save(_figure(series, title), path)


def check_suffix(path: str) -> None:
    """Whether a picture can be written under that name.

    Raises:
        UsageError: it cannot.
    """
    if Path(path).suffix.lower() not in SUFFIXES:
        raise UsageError("output", path, f"a file that ends in {', '.join(SUFFIXES)}")


def save(figure: Figure, path: str) -> None:
    """Write a figure, without a date: the same figure gives the same file.

    Raises:
        UsageError: the file cannot be written.
    """
    suffix = Path(path).suffix.lower()
    dated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    part = f"{path}.part"
    try:
        figure.savefig(part, format=suffix[1:], dpi=DOTS_AN_INCH, metadata=dated.get(suffix))
        # In one step: whoever watches the file never sees half a picture.
        os.replace(part, path)
    except OSError as error:
        raise UsageError("output", path, f"a file that can be written ({error})") from None


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
    all_axes[-1].set_xlabel("time, s" if timed else "place in the stream, bytes (it has no times)")
    figure.align_ylabels(all_axes)
    figure.suptitle(title, fontsize=11)
    return figure


def _panels(series: Series) -> list[Panel]:
    """What there is something to see of."""
    joints, coords = series.tracks["joints"], series.tracks["coordinates"]
    panels: list[Panel] = []
    if joints.at:
        names = [f"J{joint + 1}" for joint in range(len(joints.rows[0]))]
        panels.append(("joints, °", lambda axes: _lines(axes, joints, names, 0)))
    if coords.at:
        panels.append(("end, mm", lambda axes: _lines(axes, coords, ["x", "y", "z"], 0)))
        panels.append(("end, °", lambda axes: _lines(axes, coords, ["rx", "ry", "rz"], 3)))
    each = "per second" if series.axis == "seconds" else "per 1000 bytes"
    panels.append((f"frames heard\n{each}", lambda axes: _frames(axes, series)))
    panels.append((f"noise, bytes\n{each}", lambda axes: _noise(axes, series)))
    replies = series.replies
    if replies is not None and (replies.taken or replies.missing):
        panels.append(("reply time, ms", lambda axes: _replies(axes, replies)))
    return panels


def _lines(axes: Axes, track: Track, names: Sequence[str], first: int) -> None:
    for index, name in enumerate(names):
        values = [row[first + index] for row in track.rows]
        look: dict[str, Any] = {
            "color": COLOURS[index % 6],
            "linestyle": DASHES[index % 6],
            "linewidth": 1.3,
        }
        # A lone answer would be a line without length.
        axes.plot(track.at, values, label=name, marker="." if len(values) < 2 else None, **look)


def _frames(axes: Axes, series: Series) -> None:
    _bars(axes, series, [(at, 1) for at in series.frames], COLOURS[0])


def _noise(axes: Axes, series: Series) -> None:
    _bars(axes, series, series.noise, COLOURS[1])
    if not series.noise:
        axes.set_ylim(0, 1)
        axes.set_yticks([0])
        axes.text(0.5, 0.5, "none", transform=axes.transAxes, ha="center", color="#666666")


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
    """1, 2 or 5 times a power of ten: about ``BARS`` of them, and not finer than a tenth unit."""
    wish = max(end / BARS, unit / 10)
    power = 10.0 ** ceil(log10(wish) - 1)
    return float(next(step * power for step in (1, 2, 5, 10) if step * power >= wish * 0.999))


def _replies(axes: Axes, replies: Replies) -> None:
    late = set(replies.late)
    timely = [reply for reply in replies.taken if reply not in late]
    _marks(axes, timely, "in time", marker=".", color=COLOURS[0], s=12)
    _marks(axes, replies.late, "late", marker="^", color=COLOURS[1], s=28)
    axes.set_ylim(bottom=0)
    top = axes.get_ylim()[1] / 1000
    lost = [(at, top) for at in replies.missing]
    _marks(axes, lost, "no reply", marker="x", color="#000000", s=28)


def _marks(axes: Axes, marks: Sequence[tuple[float, float]], label: str, **look: Any) -> None:
    if marks:
        # At the edges too: most replies take next to no time, beside the late ones.
        axes.scatter(
            [at for at, _ in marks], [1000 * took for _, took in marks], label=label, **look
        )
