"""What is explored: the kinds of requests, what the arm replies to each, and the events."""

from __future__ import annotations

from typing import Any, NamedTuple

from cobotwire import codec as codecs
from cobotwire.editions import mycobot, mycobot280, pro400
from cobotwire.session import RetryPolicy
from cobotwire.session.request import RequestEncoder

Event = tuple[str, ...]
POLICY = RetryPolicy(attempts=2, shortest_attempt=0.125, grace=0.5)
WAIT, TICK = 0.25, 0.0625


class Kind(NamedTuple):
    """A request, the values of each reply that the arm may give, and how long its caller waits."""

    command: str
    values: tuple[Any, ...] = ()
    replies: tuple[tuple[Any, ...], ...] = (((1,)),)
    patience: float | None = None


KINDS = {
    "plain": Kind("get_tof_distance"),
    "hurried": Kind("get_tof_distance", patience=0.1875),
    "long": Kind("get_angles", replies=(((0.0,) * 6,),)),
    # Each reply repeats the number of the pin.
    "pin 1": Kind("get_digital_input", (1,), ((1, 0),)),
    "pin 2": Kind("get_digital_input", (2,), ((2, 0),)),
    # The second reply has the bytes of the request.
    "servo": Kind("is_servo_enable", (1,), ((1, 0), (1,))),
    "moving query": Kind("init_gripper"),
    "text": Kind("get_ssid_pwd", replies=((),)),
    "color": Kind("set_color", (1, 2, 3), ((1,), ()), WAIT),
    "unwatched color": Kind("set_color", (1, 2, 3)),
    # The second acknowledgement has the bytes of the request.
    "power": Kind("power_on", (), ((1,), ()), WAIT),
    "motion": Kind("send_angle", (1, 10, 50), patience=WAIT),
    # The coordinates contain a whole frame: FE FE 02 10 FA.
    "frame inside": Kind("set_tool_reference", ((-25.8, 52.8, -153.5, 0, 0, 0),)),
}

_names = {kind.command for kind in KINDS.values()} - {"get_digital_input"}
_known = [command for command in mycobot280.TABLE.commands if command.name in _names]
# With its role, the exchange would know from the start when motions are acknowledged.
_event = pro400.TABLE.command("motion_ended")._replace(role="")
_commands = (*_known, mycobot.TABLE.command("get_digital_input"), _event)
CODEC = codecs.load(mycobot280.TABLE._replace(commands=_commands), "native")
_encode = RequestEncoder(CODEC).encode
REQUESTS = {name: _encode(kind.command, kind.values) for name, kind in KINDS.items()}
REPLIES = {
    name: [CODEC.encode(kind.command, "reply", values) for values in kind.replies if name != "text"]
    for name, kind in KINDS.items()
}
REPLIES["text"] = [b"ssid: a password: b"]
EVENT = CODEC.encode("motion_ended", "reply", (0,))


class Topic(NamedTuple):
    """The requests and the events that may happen, and the ways in which a write may fail.

    ``cut 3``: 3 bytes are taken, ``cut -1``: all but one; ``torn``: likewise, but the number is not
    reported; ``lost``: all are taken, the arm gets only these, and the connection ends.
    """

    kinds: tuple[str, ...]
    events: tuple[str, ...]
    writes: tuple[str, ...] = ()
    echoes: bool = False


_WRITES = ("slow", "cut 1", "cut 3", "cut -1", "torn 3", "torn -1", "lost 3", "lost -1")
_TIMES = ("pass", "tick")
_OTHERS = ("arrive", "arrive unread", "cut", "damaged", "give up", "babble", "event", "write")
TOPICS = {
    "everything": Topic(tuple(KINDS), (*_TIMES, *_OTHERS, "lose", "reopen"), _WRITES),
    "queries": Topic(
        ("plain", "hurried", "pin 1", "pin 2", "servo", "moving query"),
        (*_TIMES, "arrive", "give up"),
    ),
    "unread": Topic(("plain",), (*_TIMES, "arrive unread", "babble", "write"), ("slow",)),
    "settings": Topic(
        ("color", "unwatched color", "power", "motion"), (*_TIMES, "arrive", "event")
    ),
    "damage": Topic(("plain", "long", "text", "color"), ("pass", "arrive", "cut", "damaged")),
    "writes": Topic(
        ("pin 1", "motion", "frame inside"), ("pass", "write", "lose", "reopen"), _WRITES
    ),
    "reopening": Topic(("plain", "color"), (*_TIMES, "arrive", "lose", "reopen")),
    "echoes": Topic(("plain", "servo", "power"), (*_TIMES, "arrive"), echoes=True),
}
