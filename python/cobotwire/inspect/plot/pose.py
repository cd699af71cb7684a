"""Draw the arm as a stick figure from its kinematics: from the side and from above."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, hypot, sin
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cobotwire.inspect.plot.charts import COLOURS, SETTINGS, save
from cobotwire.kinematics import geometry_of
from cobotwire.kinematics.forward import frames
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Table

Point = tuple[float, float, float]

BASE: Point = (0.0, 0.0, 0.0)


def points(table: Table, angles: Sequence[float]) -> list[Point]:
    """Return the base, the origins of the joint frames and the flange, in millimetres.

    Raises:
        UsageError: the geometry of the edition's arm is not known.
    """
    geometry = geometry_of(table)
    if geometry is None:
        message = f"edition {table.edition}: {table.robot.why_no_geometry}"
        raise UsageError("edition", table.edition, message=message)
    return [BASE, *(frame.origin for frame in frames(geometry, angles))]


def draw(table: Table, angles: Sequence[float], path: str) -> None:
    """Draw the arm with its joints at ``angles``, in degrees.

    Raises:
        UsageError: the geometry is not known, or the file cannot be written.
    """
    found = points(table, angles)
    with mpl.rc_context(SETTINGS):
        figure = Figure(figsize=(9.6, 4.6), layout="constrained")
        side, above = figure.subplots(1, 2)
        _view(side, _from_the_side(found), ("reach, mm", "height z, mm"), "from the side")
        _view(above, [(x, y) for x, y, _ in found], ("x, mm", "y, mm"), "from above")
        side.axhline(0, color="#666666", linewidth=0.8)
        joints = "  ".join(f"J{joint + 1} {angle:.1f}°" for joint, angle in enumerate(angles))
        x, y, z = found[-1]
        title = [joints, f"flange at x {x:.1f}  y {y:.1f}  z {z:.1f} mm"]
        # The name of a file must not be read as a formula.
        remark = table.robot.geometry_remark.replace("$", r"\$")
        figure.suptitle("\n".join(filter(None, [*title, remark])), fontsize=10)
        save(figure, path)


def _from_the_side(found: Sequence[Point]) -> list[tuple[float, float]]:
    """Project onto the upright plane through base and flange, which shows the full reach."""
    x, y, _ = found[-1]
    turned = atan2(y, x) if hypot(x, y) > 1e-9 else 0.0
    return [(px * cos(turned) + py * sin(turned), pz) for px, py, pz in found]


def _view(
    axes: Axes, flat: Sequence[tuple[float, float]], labels: tuple[str, str], title: str
) -> None:
    style: dict[str, Any] = {"color": COLOURS[0], "linewidth": 3, "solid_capstyle": "round"}
    axes.plot([a for a, _ in flat], [b for _, b in flat], marker="o", markersize=5, **style)
    _mark(axes, flat[0], "base", "s", "#000000", (9, -15))
    _mark(axes, flat[-1], "flange", "D", COLOURS[1], (9, 5))
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.15)
    axes.set_xlabel(labels[0])
    axes.set_ylabel(labels[1])
    axes.set_title(title, fontsize=10)


def _mark(
    axes: Axes,
    place: tuple[float, float],
    label: str,
    marker: str,
    colour: str,
    beside: tuple[float, float],
) -> None:
    axes.plot(*place, marker=marker, color=colour, markersize=8, linestyle="none")
    axes.annotate(label, place, textcoords="offset points", xytext=beside, color=colour)
