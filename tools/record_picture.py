"""Record the picture of the README: a simulated arm, a program that drives it, and ``monitor``.

    python tools/record_picture.py docs/pictures

It starts ``cobotwire sim``, ``cobotwire monitor`` and Python, each on a terminal of its own, types
the lines of ``PROGRAM``, and writes what the screens show: ``arm.svg``, which is animated, and
``arm-still.svg``. The arm is drawn from the angles that it reports, with its edition's kinematics.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from math import cos, radians, sin
from pathlib import Path
from typing import NamedTuple

from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.kinematics import geometry_of
from cobotwire.kinematics.forward import frames
from terminal import Terminal
from terminal_picture import FONT, Film, Screen, screen_of

FRAMES_A_SECOND = 10
PROGRAM = (
    "arm.power_on()",
    "arm.move_angles([40, -45, -70, 25, 0, 0], speed=70)",
    "arm.get_coords()",
    "arm.send_angles([0, 150, 0, 0, 0, 0], speed=70)",
    "arm.move_angles([-110, -80, -40, 30, 0, 0], speed=90)",
    "arm.go_home(speed=90)",
)
PROMPT = ">>>"
# Python shows the last line of a traceback, which has the error.
START = "import sys; sys.tracebacklimit = 0\n"
# The view: turned about the upright axis, and seen from above; millimetres to pixels.
TURNED, RAISED, SCALE = radians(-55), radians(20), 0.5
CENTRE = (158.0, 262.0)
BAR = "#161b22"
WIDTH, HEIGHT = 880, 530
LEFT, TOP, LINE, CELL = 316.0, 46.0, 19.0, 8.6


class Recorded(NamedTuple):
    """What was shown, one item for each frame: the pose and the two screens."""

    angles: list[tuple[float, ...]]
    python: list[Screen]
    monitor: list[Screen]


def record(program: Sequence[str] = PROGRAM, port: int = 9000) -> Recorded:
    """Start all programs, type ``program`` and return what was shown meanwhile."""
    with ExitStack() as stack:
        words = ("sim", "--quiet", "--tcp", f":{port}")
        sim = stack.enter_context(Terminal(*words, columns=80, lines=10))
        sim.until(lambda: "socket://" in sim.text())
        url = next(row for row in sim.rows() if row.startswith("socket://"))
        start = Path(stack.enter_context(tempfile.TemporaryDirectory()), "start.py")
        start.write_text(START)
        python = stack.enter_context(
            Terminal(program=[sys.executable, "-q"], columns=64, lines=12, PYTHONSTARTUP=str(start))
        )
        python.until(lambda: _prompts(python))
        monitor = stack.enter_context(Terminal("monitor", url, "--rate", "10", columns=98, lines=9))
        monitor.until(lambda: "lasterror" in monitor.text())
        arm = stack.enter_context(MyCobot280(url))
        found = Recorded([], [], [])
        for _ in _typed(python, ["from cobotwire import MyCobot280", f'arm = MyCobot280("{url}")']):
            # A program blocks if the output on its terminal is not read.
            monitor.read()
            time.sleep(1 / FRAMES_A_SECOND)
        began = time.monotonic()
        for number, _ in enumerate(_typed(python, program), 1):
            sim.read()
            monitor.read()
            found.angles.append(tuple(arm.get_angles()))
            found.python.append(screen_of(python))
            found.monitor.append(screen_of(monitor))
            time.sleep(max(0.0, began + number / FRAMES_A_SECOND - time.monotonic()))
        return found


def _typed(python: Terminal, program: Sequence[str]) -> Iterator[None]:
    """Type each line when the line before it has returned; yield once for each frame."""
    for line in program:
        for at in range(0, len(line), 6):
            python.press(line[at : at + 6].encode())
            yield from _frames(python, 1)
        before = python.rows()
        python.press(b"\n")
        while python.rows() == before or not _prompts(python):
            yield from _frames(python, 1)
        yield from _frames(python, 5)
    yield from _frames(python, 10)


def _prompts(python: Terminal) -> bool:
    return "\n".join(python.rows()).rstrip("\n").endswith(PROMPT)


def _frames(python: Terminal, count: int) -> Iterator[None]:
    for _ in range(count):
        python.read()
        yield


def drawn(recorded: Recorded, still: int | None = None) -> str:
    """Return the picture as SVG; with ``still``, only the frame with that number."""
    seconds = len(recorded.angles) / FRAMES_A_SECOND
    poses = recorded.angles if still is None else [recorded.angles[still]]
    monitor_top = HEIGHT - 9 * LINE - 14
    python = Film(recorded.python, CELL, LINE).svg(still, seconds)
    monitor = Film(recorded.monitor, CELL, LINE).svg(still, seconds)
    return f"""\
<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" \
font-family="{FONT}" font-size="14" xml:space="preserve">
<title>A simulated arm, a Python program that drives it, and cobotwire monitor</title>
<rect width="{WIDTH}" height="{HEIGHT}" rx="10" fill="#0d1117"/>
{_bar(0, 0, LEFT - 8, "cobotwire sim")}
{_bar(LEFT - 8, 0, WIDTH - LEFT + 8, "python")}
{_bar(0, monitor_top - 40, WIDTH, "cobotwire monitor")}
{_arm(poses, seconds)}
<svg x="{LEFT + 6:g}" y="{TOP - 4:g}">{python}</svg>
<svg x="16" y="{monitor_top:g}">{monitor}</svg>
</svg>
"""


def _bar(x: float, y: float, width: float, title: str) -> str:
    return (
        f'<rect x="{x + 1:g}" y="{y + 1:g}" width="{width - 2:g}" height="30" rx="9" fill="{BAR}"/>'
        f'<text x="{x + 16:g}" y="{y + 21:g}" fill="#8b949e">$ {title}</text>'
    )


def _arm(poses: Sequence[Sequence[float]], seconds: float) -> str:
    """Return floor, shadow and arm; the arm moves from pose to pose in ``seconds``."""
    geometry = geometry_of(TABLE)
    assert geometry is not None, "the geometry of the 280 is known"
    every = [
        [(0.0, 0.0, 0.0), *(pose.origin for pose in frames(geometry, angles))] for angles in poses
    ]
    flat = [[_projected(point) for point in points] for points in every]
    shadow = [[_projected((x, y, 0.0)) for x, y, _ in points] for points in every]
    rings = "".join(
        f'<polygon points="{_ring(radius)}" fill="none" stroke="#30363d"/>'
        for radius in (100, 200, 280)
    )
    joints = "".join(
        _moved(
            "circle",
            {"cx": [f[at][0] for f in flat], "cy": [f[at][1] for f in flat]},
            seconds,
            look,
        )
        for at, look in _joints(len(flat[0]))
    )
    return "\n".join(
        (
            rings,
            _line(shadow, seconds, 'stroke="#010409" stroke-width="12"'),
            _line(flat, seconds, 'stroke="#4c8dd6" stroke-width="15"'),
            _line(flat, seconds, 'stroke="#a5d0ff" stroke-width="9"'),
            joints,
        )
    )


def _joints(count: int) -> Iterator[tuple[int, str]]:
    yield 0, 'r="13" fill="#30363d" stroke="#8b949e" stroke-width="2"'
    for at in range(1, count - 1):
        yield at, 'r="5.5" fill="#0d1117" stroke="#4c8dd6" stroke-width="2"'
    yield count - 1, 'r="6" fill="#f0883e"'


def _projected(point: Sequence[float]) -> tuple[float, float]:
    x, y, z = point
    across = x * cos(TURNED) - y * sin(TURNED)
    deep = x * sin(TURNED) + y * cos(TURNED)
    up = z * cos(RAISED) + deep * sin(RAISED)
    return CENTRE[0] + across * SCALE, CENTRE[1] - up * SCALE


def _ring(radius: float) -> str:
    turns = [radians(degrees) for degrees in range(0, 360, 10)]
    return _points([_projected((radius * cos(t), radius * sin(t), 0.0)) for t in turns])


def _points(points: Sequence[tuple[float, float]]) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points)


def _line(lines: Sequence[Sequence[tuple[float, float]]], seconds: float, look: str) -> str:
    texts = [_points(points) for points in lines]
    style = f'fill="none" stroke-linejoin="round" stroke-linecap="round" {look}'
    change = _animated("points", texts, seconds)
    return f'<polyline points="{texts[0]}" {style}>{change}</polyline>'


def _moved(tag: str, places: dict[str, list[float]], seconds: float, look: str) -> str:
    texts = {name: [f"{value:.1f}" for value in values] for name, values in places.items()}
    first = " ".join(f'{name}="{values[0]}"' for name, values in texts.items())
    changes = "".join(_animated(name, values, seconds) for name, values in texts.items())
    return f"<{tag} {first} {look}>{changes}</{tag}>"


def _animated(name: str, values: Sequence[str], seconds: float) -> str:
    if len(set(values)) == 1:
        return ""
    # The values between two changes need no key: they are on the line between them.
    keys = [at for at in range(len(values)) if not _between(values, at)]
    last = len(values) - 1
    times = ";".join(f"{at / last:.4f}".rstrip("0").rstrip(".") for at in keys)
    texts = ";".join(values[at] for at in keys)
    timing = f'dur="{seconds:g}s" repeatCount="indefinite"'
    return f'<animate attributeName="{name}" {timing} keyTimes="{times}" values="{texts}"/>'


def _between(values: Sequence[str], at: int) -> bool:
    return 0 < at < len(values) - 1 and values[at - 1] == values[at] == values[at + 1]


def main(folder: Path) -> None:
    """Record, and write both pictures into ``folder``."""
    recorded = record()
    folder.mkdir(exist_ok=True)
    (folder / "arm.svg").write_text(drawn(recorded), encoding="utf-8")
    # The frame in which most of the program is on the screen, and the arm is not at home.
    still = max(
        range(len(recorded.angles)), key=lambda at: (abs(recorded.angles[at][0] + 110) < 1, at)
    )
    (folder / "arm-still.svg").write_text(drawn(recorded, still), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
