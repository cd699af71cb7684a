"""The evidence finds the limit that explains a wrong result, also where values are equal."""

from __future__ import annotations

from attack.arm import Made, Span
from attack.evidence import COPY, Evidence
from attack.line import Delivered
from attack.record import Call, Record
from cobotwire import codec as codecs
from cobotwire.editions import load

CODEC = codecs.load(load("mycobot280").TABLE)
NAME = "is_in_position"


def request(x: float) -> bytes:
    """Return the bytes of a query about the position (x, 0, 0)."""
    return CODEC.encode(NAME, "request", [(x, 0.0, 0.0, 0.0, 0.0, 0.0), 0])


def reply(x: float, arrived: float, value: bool) -> Made:
    """Return the arm's reply to that query."""
    return Made(CODEC.encode(NAME, "reply", [value]), request(x), arrived, False, value)


def call(number: int, x: float, began: float, ended: float, value: bool) -> Call:
    """Return a call that sent that query, and ended with a value."""
    return Call(number, 1, NAME, request(x), None, True, began, ended, "value", value)


def evidence_of_a_chain(second_ended: float) -> tuple[Evidence, Call]:
    """Return the evidence of three calls, and the third, which took the reply to the second.

    The first reply is delivered twice, and all values are equal. So the second call took the copy
    if it ended before its own reply arrived.
    """
    first, second = reply(1.0, 10.00, False), reply(2.0, 10.07, False)
    calls = [
        call(1, 1.0, 9.99, 10.01, False),
        call(2, 2.0, 10.06, second_ended, False),
        call(3, 3.0, 10.15, 10.24, False),
    ]
    record = Record()
    record.calls += calls
    record.handed += [(each.began, each.request) for each in calls]
    spans = [Span(made.frame, made, "reply") for made in (first, first, second)]
    size = len(first.frame)
    times = (10.00, 10.12, 10.23)
    delivered = [Delivered(at, n * size, (n + 1) * size) for n, at in enumerate(times)]
    return Evidence(CODEC, spans, delivered, record, 0.3), calls[-1]


def test_call_that_ended_before_its_reply_arrived_took_a_copy() -> None:
    evidence, last = evidence_of_a_chain(second_ended=10.13)
    assert evidence.limit_of(last, kept=False) == COPY


def test_reply_that_its_own_call_could_take_explains_nothing() -> None:
    evidence, last = evidence_of_a_chain(second_ended=10.235)
    assert evidence.limit_of(last, kept=False) == ""
