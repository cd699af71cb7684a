"""Draw an arm from its geometry, as SVG for the page of its robot."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import cos, pi, radians, sin

from cobotwire.editions import load
from cobotwire.kinematics import geometry_of
from cobotwire.kinematics.forward import frames

# The view of the arm: turned about the vertical axis, and seen from above.
TURNED, RAISED = radians(30), radians(20)
POSE = (0.0, -30.0, 60.0, -30.0, 0.0, 0.0)
MARGIN = 12.0
CIRCLE = [(cos(turn * pi / 18), sin(turn * pi / 18)) for turn in range(36)]


def picture(edition: str) -> str:
    """Return a figure of the edition's arm, on a floor with a ring every 100 mm."""
    geometry = geometry_of(load(edition).TABLE)
    assert geometry is not None, f"the geometry of {edition} is not known"
    at_zero, bent = (
        [
            _flat(point)
            for point in ((0.0, 0.0, 0.0), *(each.origin for each in frames(geometry, pose)))
        ]
        for pose in ((0.0,) * geometry.joints, POSE)
    )
    rings = [[_flat((r * x, r * y, 0.0)) for x, y in CIRCLE] for r in (100, 200)]
    across, down = zip(*at_zero, *bent, *rings[-1])
    corner = min(across) - MARGIN, min(down) - MARGIN
    size = max(across) - corner[0] + MARGIN, max(down) - corner[1] + MARGIN
    # Put labels alternately to the right and left, since the axes of two joints may meet.
    joints = "".join(
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="7"/>'
        f'<text x="{x + (14 if n % 2 else -30):.1f}" y="{y + 6:.1f}">j{n}</text>'
        for n, (x, y) in enumerate(bent[:-1], 1)
    )
    return f"""\
<figure class="arm">
<svg viewBox="{_points([corner, size])}" role="img" aria-label="The arm with its joints">
{"".join(f'<polygon points="{_points(ring)}"/>' for ring in rings)}
<polyline class="zero" points="{_points(at_zero)}"/>
<polyline points="{_points(bent)}"/>
{joints}
</svg>
<figcaption>The joints at {", ".join(f"{angle:g}" for angle in POSE)} degrees; dotted: all at zero.
The rings have radii of 100 and 200 mm.</figcaption>
</figure>
"""


def _flat(point: Sequence[float]) -> tuple[float, float]:
    x, y, z = point
    across = x * cos(TURNED) - y * sin(TURNED)
    deep = x * sin(TURNED) + y * cos(TURNED)
    return across, -z * cos(RAISED) - deep * sin(RAISED)


def _points(points: Iterable[Sequence[float]]) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
