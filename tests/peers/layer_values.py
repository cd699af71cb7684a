"""Compare which drawn values the maker's class and ours send, and the first frame of each."""

from __future__ import annotations

from itertools import groupby
from typing import Any, NamedTuple

from cobotwire.editions import load
from cobotwire.protocol.errors import UsageError
from differences import Difference
from drawn_values import Drawn, drawn
from layer_comparison import Compared, chosen, class_of, is_missing
from pymycobot_ports import RecordingPort, RecordingTransport, Written
from robots.comparison import is_truncated
from robots.driving import stepped
from robots.robot import Robot

ONLY_OURS, ONLY_THEIRS, OTHER_BYTES = "only ours", "only theirs", "other bytes"
SILENT = "nothing is written"


class Tried(NamedTuple):
    """A drawn value by its label, how both sides differ, and whether ours sends it."""

    label: Any
    side: str
    is_sent: bool


class Rejected(str):
    """The text of an error that a call raised before it wrote."""


class Crashed(str):
    """The text of an error that does not reject an argument."""


def compare_values(robot: Robot, which: int | str = 1) -> Compared:
    """Compare drawn calls of methods of a class."""
    kind = class_of(robot)
    methods = [m for m in robot.public if callable(getattr(kind, m, None))]
    methods = chosen(robot, methods, which)
    peer = robot.on(RecordingPort())
    tried: dict[tuple[str, str], list[Tried]] = {}
    for each in drawn(robot, peer, methods):
        with stepped():
            theirs, ours = _sent(peer, each), _sent(_layer(robot), each)
        found = Tried(each.label, _side(robot, theirs, ours), not isinstance(ours, Rejected))
        tried.setdefault((each.method, each.parameter), []).append(found)
    shown = {
        Difference(method, parameter, f"{side}{_shown(side, values)}")
        for (method, parameter), values in tried.items()
        for side in {each.side for each in values} - {""}
    }
    return Compared(sum(map(len, tried.values())), set(methods), shown)


def _layer(robot: Robot) -> Any:
    """Return our class on a transport that raises an exception at its first write."""
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
        theirs = not type(who).__module__.startswith("cobotwire")
        # Our methods of requests with several variants raise TypeError for a missing argument.
        rejects = theirs or isinstance(error, UsageError) or is_missing(error)
        return Rejected(error) if rejects else Crashed(f"{type(error).__name__}: {error}")
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


def _shown(side: str, values: list[Tried]) -> str:
    """Return the difference: for a list, its size or its numbers; otherwise also the value that
    ours sends."""
    labels = {each.label for each in values if each.side == side}
    if any(isinstance(each, str) for each in labels):
        kinds = {"numbers" if "=" in each else each.strip("[]") for each in labels}
        return f": {', '.join(sorted(kinds))}"
    if labels == {None}:
        return ": None"
    numbers = {each.label: each.is_sent for each in values if each.label is not None}
    whole = (number for number in sorted(numbers) if number == int(number))
    runs = [[*run] for is_sent, run in groupby(whole, numbers.__getitem__) if is_sent]
    sent = ", ".join(dict.fromkeys((f"{run[0]}..{run[-1]}") for run in runs)) or "nothing"
    decimals = any(numbers[each] for each in numbers if each != int(each))
    return f"; ours sends {sent}{' with decimals' * decimals}{' (None, too)' * (None in labels)}"
