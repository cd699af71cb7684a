"""Steps that random talks rarely take: the exchanges in Python and in Rust do the same."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.protocol.loading import table_of
from cobotwire.session import (
    AckReceived,
    Exchange,
    LateReply,
    ReplyRejected,
    SessionEvent,
    UnexpectedFrame,
)
from cobotwire.session.request import RequestEncoder
from probe import Probe, needed
from session.one_caller import ONCE, submit
from session.twins import Recorder
from vectors import ROOT

pytestmark = needed
MYCOBOT = ROOT / "python/cobotwire/editions/mycobot/edition.json"
COLOR, ANGLE = ("set_color", (1, 2, 3)), ("send_angle", (1, 10, 50))
PIN_1, PIN_2 = ("get_digital_input", (1,)), ("get_digital_input", (2,))


class Both:
    """An exchange in Python; its steps are repeated in Rust."""

    def __init__(self, recorder: Recorder, codec: Codec) -> None:
        self.codec, self.recorder = codec, recorder
        self.encode = RequestEncoder(codec).encode
        self.exchange = Exchange(codec)

    def order(self, named: tuple[str, Any], now: float, within: float | None = None) -> None:
        self.exchange.send_one_way(self.encode(*named), now, within)

    def query(self, named: tuple[str, Any], now: float) -> None:
        submit(self.exchange, self.encode(*named), now, ONCE, 0.1)
        assert self.exchange.outgoing(now, True)

    def reply(self, command: str, *values: Any) -> bytes:
        frame: bytes = self.codec.encode(command, "reply", values)
        return frame

    def receive(self, data: bytes, now: float) -> type[SessionEvent]:
        [event] = self.exchange.receive(data, now)
        return type(event)


def _document() -> dict[str, Any]:
    """Return an edition with two acknowledged requests, and a query with the id of one of them."""
    document: dict[str, Any] = json.loads(MYCOBOT.read_text(encoding="utf-8"))
    commands = {command["name"]: command for command in document["commands"]}
    for name, _ in (COLOR, ANGLE):
        commands[name].update(ack=True, reply=[[]])
    query = commands["is_power_on"] | {"name": "get_color", "id": commands[COLOR[0]]["id"]}
    document["commands"].append(query)
    return document


@pytest.fixture
def both(probe: Probe, tmp_path: Path) -> Iterator[Both]:
    """Yield an exchange in Python; Rust repeats its steps after the test."""
    path, document = tmp_path / "edition.json", _document()
    path.write_text(json.dumps(document), encoding="utf-8")
    codec = codecs.load(table_of(document), "native")
    with Recorder(codec, str(path)) as recorder:
        made = Both(recorder, codec)
        yield made
        states = recorder.check(probe.ask)
        assert all(state.count("OutstandingReply {") <= 1 for state in states)


@pytest.mark.parametrize(
    ("named", "now", "event"),
    [
        (COLOR, 0.95, AckReceived),
        (COLOR, 1.0, UnexpectedFrame),
        (ANGLE, 59.9, AckReceived),
        (ANGLE, 60.0, UnexpectedFrame),
    ],
)
def test_ack_counts_until_its_time_is_over(
    both: Both, named: tuple[str, Any], now: float, event: type[SessionEvent]
) -> None:
    both.order(named, 0.0)
    assert both.receive(both.reply(named[0]), now) is event


def test_expired_ack_counts_while_an_earlier_one_may_still_come(both: Both) -> None:
    both.order(COLOR, 0.0, within=31.0)
    for now in (0.0, 2.0):
        both.order(COLOR, now)
    for _ in range(3):
        # A chunk ends inside the frame, so nobody knows when its first byte came.
        ack = both.reply("set_color")
        both.exchange.receive(ack[:3], 2.1)
        assert both.receive(ack[3:], 2.2) is AckReceived


def test_illegal_reply_is_unexpected_if_one_of_its_command_is_outstanding(both: Both) -> None:
    illegal = both.reply(PIN_2[0], 2, 1).replace(b"\2\1", b"\2\7")
    both.query(PIN_2, 0.0)
    assert both.receive(illegal, 0.05) is ReplyRejected
    both.query(PIN_1, 0.1)
    both.exchange.wake(0.2)
    both.query(PIN_2, 0.2)
    assert both.receive(illegal, 0.25) is UnexpectedFrame
    assert both.receive(both.reply(PIN_1[0], 1, 1), 0.25) is LateReply


def test_one_way_requests_do_not_collect_outstanding_replies(both: Both) -> None:
    for number in range(100):
        both.order(COLOR, 2.0 * number)
        both.recorder.note_state(both.exchange)
        assert len(both.exchange._outstanding.replies) == 1
