"""Compare which drawn values the maker's class and ours send, and the first frame of each."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from cobotwire.editions import load
from cobotwire.protocol.errors import UsageError
from differences import Difference
from drawn_values import Drawn, drawn
from layer_comparison import Compared, chosen, class_of, is_missing
from pymycobot_ports import RecordingPort, RecordingTransport, Written
from robots.comparison import is_truncated
from robots.driving import stepped
from robots.robot import Robot

# A longer list of values is counted.
LONGEST = 60
ONLY_OURS, ONLY_THEIRS, OTHER_BYTES = "only ours", "only theirs", "other bytes"
SILENT = "nothing is written"


class Rejected(str):
    """The text of an error that a call raised before it wrote; numbers are left out."""


class Crashed(str):
    """The text of an error that is no rejection of an argument."""


def compare_values(robot: Robot, which: int | str = 1) -> Compared:
    """Compare drawn calls of methods of a class."""
    kind = class_of(robot)
    methods = [m for m in robot.public if callable(getattr(kind, m, None))]
    methods = chosen(robot, methods, which)
    peer = robot.on(RecordingPort())
    found: dict[tuple[str, str, str], list[tuple[Any, str]]] = {}
    count = 0
    for each in drawn(robot, peer, methods):
        count += 1
        with stepped():
            theirs, ours = _sent(peer, each), _sent(_layer(robot), each)
        if side := _side(robot, theirs, ours):
            why = theirs if side == ONLY_OURS else ours
            labels = found.setdefault((each.method, each.parameter, side), [])
            labels.append((each.label, why if isinstance(why, str) else ""))
    shown = {
        Difference(method, parameter, f"{side}: {_shown(labels)}")
        for (method, parameter, side), labels in found.items()
    }
    return Compared(count, set(methods), shown)


def _layer(robot: Robot) -> Any:
    """Return our class on a transport that raises its first write."""
    made = object.__new__(class_of(robot))
    made._raises, made._is_open, made._waits = True, True, True
    made.arm = load(robot.edition).CLIENT(RecordingTransport())
    return made


def _sent(who: Any, call: Drawn) -> bytes | str:
    """Return the first bytes that a call sends, or why it sends nothing."""
    try:
        getattr(who, call.method)(**call.arguments)
    except Written as port:
        return port.data
    except Exception as error:
        text = f"{type(error).__name__}: {error}"
        theirs = not type(who).__module__.startswith("cobotwire")
        # Our methods of requests with several variants raise TypeError for a missing argument.
        rejects = theirs or isinstance(error, UsageError) or is_missing(error)
        return Rejected(_without_numbers(text)) if rejects else Crashed(text)
    return SILENT


def _side(robot: Robot, theirs: bytes | str, ours: bytes | str) -> str:
    if isinstance(ours, Crashed):
        return f"ours fails: {ours}"
    if theirs == ours or (isinstance(theirs, Rejected) and isinstance(ours, Rejected)):
        return ""
    if isinstance(theirs, Rejected):
        return ONLY_OURS
    if isinstance(ours, Rejected):
        return ONLY_THEIRS
    if isinstance(theirs, bytes) and isinstance(ours, bytes) and is_truncated(robot, theirs, ours):
        return ""
    return OTHER_BYTES


def _without_numbers(text: str) -> str:
    return re.sub(r"-?\d[\d.]*", "#", text)


def _shown(labels: list[tuple[Any, str]]) -> str:
    """Return values as ranges; of lists, the texts of the rejections."""
    values = {label for label, _ in labels}
    if any(isinstance(each, str) for each in values):
        return "; ".join(sorted({why for _, why in labels}))
    numbers = sorted(each for each in values if each is not None)
    runs = [*_runs(numbers), *(["None"] if None in values else [])]
    text = ", ".join(runs)
    return text if len(text) <= LONGEST else f"{len(numbers)} values, {runs[0]} to {runs[-1]}"


def _runs(numbers: list[float]) -> Iterator[str]:
    """Return numbers as ranges of neighbours."""
    while numbers:
        size = 1
        while size < len(numbers) and numbers[size] <= numbers[size - 1] + 1:
            size += 1
        yield f"{numbers[0]}..{numbers[size - 1]}" if size > 1 else str(numbers[0])
        numbers = numbers[size:]
