"""Draw the curves of ``docs/framing.md`` from the JSON of ``bench/resync.py``."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from scoring import STEPS

Rows = Sequence[dict[str, Any]]

# Colours and marks that can be distinguished without colour vision (Okabe and Ito's palette).
LOOKS: dict[str, dict[str, Any]] = {
    "cobotwire": {"color": "#0072B2", "marker": "o"},
    "any LEN to 64": {"color": "#009E73", "marker": "s"},
    "textbook": {"color": "#D55E00", "marker": "^"},
    "pymycobot": {"color": "#444444", "marker": "D"},
}
NAMES = {
    "cobotwire": "cobotwire",
    "any LEN to 64": "same scan, any id, LEN up to 64",
    "textbook": "textbook state machine",
    "pymycobot": "pymycobot 4.0.7",
}
SETTINGS: Any = {
    "svg.hashsalt": "cobotwire",  # the same report gives the same file
    "font.family": "DejaVu Sans",
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "figure.facecolor": "white",  # readable on a dark page
    "savefig.facecolor": "white",
}


def lost_by_rate(rows: Rows) -> Figure:
    """Plot undamaged frames lost, over the rate of damage."""
    figure, axes = _canvas("All kinds of damage together, all streams of both editions")
    mixed = _some(rows, kind="mixed")
    rates = sorted({row["rate"] for row in mixed})
    for name in LOOKS:
        lost = [_lost(_some(mixed, rate=rate), name) for rate in rates]
        axes.plot(rates, lost, label=NAMES[name], **LOOKS[name])
    axes.set_xscale("log")
    axes.set_yscale("symlog", linthresh=1)
    axes.set_ylim(0, 100_000)
    axes.set_yticks([0, 1, 10, 100, 1_000, 10_000, 100_000])
    axes.set_yticklabels(["0", "1", "10", "100", "1,000", "10,000", "100,000"])
    axes.set_xlabel("damages for each byte sent")
    axes.set_ylabel("undamaged frames lost, of a million")
    return _with_legend(figure, axes)


def lost_by_kind(rows: Rows) -> Figure:
    """Plot undamaged frames lost, for each kind of damage."""
    figure, axes = _canvas("One damage in a hundred bytes, replies of both editions", height=5.6)
    rows = _some(rows, stream="catalogue", listening="reply", rate=1e-2)
    kinds = list(dict.fromkeys(row["kind"] for row in rows))
    kinds.sort(key=lambda kind: max(_lost(_some(rows, kind=kind), n) for n in LOOKS))
    for place, name in enumerate(LOOKS):
        lost = [_lost(_some(rows, kind=kind), name) for kind in kinds]
        heights = [at + 0.3 - 0.2 * place for at in range(len(kinds))]
        axes.plot(lost, heights, linestyle="none", clip_on=False, label=NAMES[name], **LOOKS[name])
    axes.set_xscale("symlog", linthresh=1)
    axes.set_xlim(0, 100_000)
    axes.set_xticks([0, 1, 10, 100, 1_000, 10_000, 100_000])
    axes.set_xticklabels(["0", "1", "10", "100", "1,000", "10,000", "100,000"])
    axes.set_yticks(range(len(kinds)), kinds)
    axes.set_xlabel("undamaged frames lost, of a million")
    axes.grid(visible=False, axis="y")
    for at in range(1, len(kinds)):
        axes.axhline(at - 0.5, color="#dddddd", linewidth=0.8)
    axes.set_ylim(-0.5, len(kinds) - 0.5)
    return _with_legend(figure, axes)


def recovery(rows: Rows) -> Figure:
    """Plot how many bytes after damage a reader finds the next undamaged frame."""
    figure, axes = _canvas("All kinds of damage, one in a hundred bytes, all streams")
    mixed = _some(rows, kind="mixed")
    some = _some(mixed, rate=max(row["rate"] for row in mixed))
    damages = sum(row["damages"] for row in some)
    spreads = {name: [row["readers"][name]["bytes_to_recovery"] for row in some] for name in LOOKS}
    for name in ("cobotwire", "textbook", "pymycobot"):
        share = _longer(spreads[name], damages)
        axes.plot(STEPS, share, markevery=4, markersize=5, label=NAMES[name], **LOOKS[name])
    ideal = _longer([row["ideal"] for row in some], damages)
    axes.plot(STEPS, ideal, color="black", linestyle=":", label="the next undamaged frame itself")
    axes.set_yscale("log")
    axes.set_xlim(0, 80)
    axes.set_ylim(1e-3, 1)
    axes.set_yticks([1, 0.1, 0.01, 0.001], ["100 %", "10 %", "1 %", "0.1 %"])
    axes.set_xlabel("bytes after the damage")
    axes.set_ylabel("share of damages after which\nno undamaged frame has been read")
    return _with_legend(figure, axes)


def bounds(each: Rows) -> Figure:
    """Plot undamaged frames lost, for the table and for bounds on LEN."""
    figure, axes = _canvas("Stream A with 10 % line noise: what limits the same scan")
    for place, (edition, colour) in enumerate((("mycobot", "#0072B2"), ("mycobot280", "#E69F00"))):
        lost = [1e6 * (1 - row["share"]) for row in each if row["edition"] == edition]
        at = [index - 0.2 + 0.4 * place for index in range(len(lost))]
        bars = axes.bar(at, lost, width=0.39, color=colour, label=f"edition {edition}", zorder=2)
        axes.bar_label(bars, [f"{value:,.0f}" for value in lost], fontsize=7.5, padding=1)
    names = [row["bound"] for row in each if row["edition"] == "mycobot"]
    words = {"the table": "the table\n(LEN and id)", "longest": "LEN up to\nthe longest"}
    axes.set_xticks(range(len(names)), [words.get(name, f"LEN\nup to {name}") for name in names])
    axes.grid(visible=False, axis="x")
    axes.set_yscale("log")
    axes.set_ylim(10, 200_000)
    axes.set_ylabel("undamaged frames lost, of a million")
    return _with_legend(figure, axes)


def _canvas(title: str, height: float = 4.2) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(7, height), layout="constrained")
    axes = figure.subplots()
    axes.set_title(title, loc="left", fontsize=10)
    return figure, axes


def _with_legend(figure: Figure, axes: Axes) -> Figure:
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def _some(rows: Rows, **wanted: object) -> list[dict[str, Any]]:
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def _lost(rows: Rows, reader: str) -> float:
    lost = sum(row["readers"][reader]["lost"] for row in rows)
    return float(1e6 * lost / sum(row["undamaged"] for row in rows))


def _longer(spreads: Rows, damages: int) -> list[float]:
    return [sum(spread["longer"][at] for spread in spreads) / damages for at in range(len(STEPS))]


def main() -> None:
    """Draw all curves."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("report", type=Path)
    parser.add_argument("folder", type=Path)
    options = parser.parse_args()
    report = json.loads(options.report.read_text())
    options.folder.mkdir(parents=True, exist_ok=True)
    with mpl.rc_context(SETTINGS):
        for name, figure in {
            "lost-by-rate": lost_by_rate(report["rows"]),
            "lost-by-kind": lost_by_kind(report["rows"]),
            "recovery": recovery(report["rows"]),
            "length-bound": bounds(report["bounds"]),
        }.items():
            path = options.folder / f"resync-{name}.svg"
            figure.savefig(path, metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    main()
