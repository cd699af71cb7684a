"""Draw reply times: one row for each query, on a logarithmic scale of milliseconds."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from statistics import quantiles
from xml.etree.ElementTree import Element

from cobotwire.conformance.report import Report
from cobotwire.conformance.reports.element import element

ROW, LEFT, WIDTH, TOP = 20, 210, 620, 24
# Shorter times are drawn as this one; a simulated arm in memory replies in less.
LEAST_MS = 0.01
TICKS_MS = (0.01, 0.1, 1, 10, 100, 1000, 10_000)


def times_plot(report: Report) -> Element:
    """Return a drawing of the full range, the middle nine tenths, the median and the deadline."""
    rows = [(name, sorted(times)) for name, times in report.reply_seconds.items() if times]
    most = max(max(times) for _, times in rows)
    scale = _Scale(1000 * max(most, *report.deadline_seconds.values(), 0.0))
    height = TOP + ROW * len(rows) + 8
    parts = [*scale.grid(height)]
    for index, (name, times) in enumerate(rows):
        deadline = report.deadline_seconds.get(name)
        parts += _row(scale, TOP + ROW * index + ROW // 2, name, times, deadline)
    width = LEFT + WIDTH + 90
    box = f"0 0 {width} {height}"
    label = "reply times by command"
    return element("svg", *parts, role="img", aria_label=label, viewBox=box, width=width)


class _Scale:
    """Converts seconds to positions by their logarithm."""

    def __init__(self, most_ms: float) -> None:
        self._last = next((tick for tick in TICKS_MS if tick >= most_ms), TICKS_MS[-1])

    def x(self, seconds: float) -> float:
        share = math.log10(max(1000 * seconds, LEAST_MS) / LEAST_MS)
        full = math.log10(self._last / LEAST_MS) or 1.0
        return round(LEFT + WIDTH * min(share / full, 1.0), 1)

    def grid(self, height: int) -> Iterator[Element]:
        for tick in (tick for tick in TICKS_MS if tick <= self._last):
            x = self.x(tick / 1000)
            yield element("path", class_="grid", d=f"M{x} {TOP - 4}V{height}")
            yield element("text", f"{tick:g} ms", x=x, y=TOP - 9, text_anchor="middle")


def _row(
    scale: _Scale, y: int, name: str, times: Sequence[float], deadline: float | None
) -> Iterator[Element]:
    low, middle, high = _spread(times)
    x1, x2 = scale.x(times[0]), scale.x(times[-1])
    title = element("title", f"{name}: {len(times)} replies, {_ms(times[0])} to {_ms(times[-1])}")
    yield element("text", name, title, x=LEFT - 10, y=y + 4, text_anchor="end")
    yield element("path", d=f"M{x1} {y}H{x2}")
    start = scale.x(low)
    yield element("path", class_="b", d=f"M{start} {y}H{max(scale.x(high), start + 1)}")
    yield element("path", class_="m", d=f"M{scale.x(middle)} {y - 7}v14")
    yield element("text", _ms(middle), x=LEFT + WIDTH + 12, y=y + 4)
    if deadline is not None:
        yield element("path", class_="d", d=f"M{scale.x(deadline)} {y - 7}v14")


def _spread(times: Sequence[float]) -> tuple[float, float, float]:
    """Return the 5th, 50th and 95th percentile."""
    if len(times) == 1:
        return times[0], times[0], times[0]
    cuts = quantiles(times, n=20, method="inclusive")
    return cuts[0], cuts[9], cuts[18]


def _ms(seconds: float) -> str:
    return f"{1000 * seconds:.2f} ms"
