"""Arms of the classes on simulated robots in stepped time."""

from __future__ import annotations

from functools import partial
from typing import Any

import cobotwire.pymycobot as layer
from cobotwire.editions import load
from cobotwire.simulator import MemoryTransport, SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from strategies import codec_of


class Replies:
    """A tool at the end of the arm that sends these bytes."""

    wait = None

    def __init__(self, edition: str, *replies: bytes) -> None:
        self._codec = codec_of(edition, "native")
        self._replies = list(replies)

    def receive(self, data: bytes) -> bytes:
        reply = self._replies.pop(0)
        variant = len(reply) - 1
        frame: bytes = self._codec.encode(
            "tool_serial_write_data", "reply", (reply,), variant=variant
        )
        return frame

    def flush(self) -> bytes:
        return b""


def made(
    name: str,
    edition: str = "",
    errors: Any = "raise",
    powered: bool = True,
    peer: Any = None,
    debug: bool = False,
    robot: str = "",
    **options: Any,
) -> tuple[Any, Any]:
    """Return an arm of a class on a simulated robot in stepped time, and that robot.

    ``edition`` is the edition of the client, and of the robot unless ``robot`` names another one.
    ``peer`` makes a peer that replaces the robot on the line; ``options`` are passed to the robot.
    """
    kind = getattr(layer, name)
    native = load(edition).CLIENT if edition else kind.NATIVE
    clock = SteppedClock()
    table = load(robot).TABLE if robot else native.table
    arm = SimulatedArm(table, clock=clock, powered=powered, **options)
    found = object.__new__(kind)
    given = arm.connect() if peer is None else peer(arm)
    found._open(partial(native, MemoryTransport(given, clock)), debug, errors)
    found.clock, found._waits = clock, True
    return found, arm
