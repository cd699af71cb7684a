"""After Ctrl-C at any step of the exchange, the next request still gets its own reply."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import FrameType
from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.session import Exchange, PendingRequest, RetryPolicy
from cobotwire.session.request import RequestEncoder
from session.one_caller import submit

POLICY = RetryPolicy(attempts=2, grace=0.5)
WAIT = 0.3
ENCODERS = [bytes.fromhex(f"FE FE 04 3B 00 {number:02X} FA") for number in range(8)]


class InterruptAt:
    """Raise KeyboardInterrupt at the n-th call or return inside the session, as a signal may."""

    def __init__(self, number: int) -> None:
        self._left = number
        self.raised = False

    def __call__(self, frame: FrameType, event: str, argument: Any) -> None:
        code = frame.f_code
        # Python ignores an exception that is raised while a generator is closed.
        if "cobotwire/session/" not in code.co_filename or code.co_name == "<genexpr>":
            return
        # Python handles signals after it calls a built-in function, not before.
        if event == "c_call":
            return
        self._left -= 1
        if self._left == 0:
            self.raised = True
            sys.setprofile(None)
            raise KeyboardInterrupt


def interrupted(number: int, step: Callable[[], object]) -> bool:
    """Run a step; return whether it was interrupted."""
    interrupt = InterruptAt(number)
    try:
        sys.setprofile(interrupt)
        step()
    except KeyboardInterrupt:
        pass
    finally:
        sys.setprofile(None)
    return interrupt.raised


@pytest.fixture
def encoder(codec: Codec) -> RequestEncoder:
    return RequestEncoder(codecs.load(TABLE, codec.name))


def scenario(
    exchange: Exchange, encoder: RequestEncoder, step: str
) -> tuple[Callable[[], object], list[PendingRequest]]:
    """Prepare an exchange for a step; return the step, and the requests that must end."""
    one = submit(exchange, encoder.encode("get_encoder", (1,)), 0.0, POLICY, WAIT)
    if step == "first sending":
        return lambda: exchange.outgoing(0.0, drained=True), [one]
    exchange.outgoing(0.0, drained=True)
    two = submit(exchange, encoder.encode("get_encoder", (2,)), 0.0, POLICY, WAIT)
    steps: dict[str, Callable[[], object]] = {
        "second sending": lambda: exchange.outgoing(0.2, drained=True),
        "reply": lambda: exchange.receive(ENCODERS[1], 0.1),
        "noise": lambda: exchange.receive(b"cmd_len error", 0.1),
        "end": lambda: exchange.wake(0.4),
        "one-way": lambda: exchange.send_one_way(encoder.encode("set_color", (1, 2, 3)), 0.1, 0.2),
    }
    if step == "giving up":
        return lambda: exchange.give_up(one), [two]
    return steps[step], [one, two]


@pytest.mark.parametrize(
    "step",
    ["first sending", "second sending", "reply", "noise", "end", "one-way", "giving up"],
)
def test_interrupt_at_any_point_of_a_step_leaves_the_exchange_usable(
    codec: Codec, encoder: RequestEncoder, step: str
) -> None:
    number = 0
    while True:
        number += 1
        exchange = Exchange(codecs.load(TABLE, codec.name))
        run, others = scenario(exchange, encoder, step)
        if not interrupted(number, run):
            break
        now = 0.5
        while not all(pending.done for pending in others):
            idle = exchange.idle_seconds(now)
            assert idle is not None, f"a request waits forever after point {number}"
            now += max(idle, 0.001)
            exchange.wake(now)
            exchange.outgoing(now, drained=True)
            assert now < 9, f"a request does not end after point {number}"
        own = submit(exchange, encoder.encode("get_encoder", (3,)), now, POLICY, WAIT)
        while not exchange.outgoing(now, drained=True):
            idle = exchange.idle_seconds(now)
            assert idle is not None
            now += max(idle, 0.001)
            exchange.wake(now)
            assert now < 9
        exchange.receive(ENCODERS[7], now + 0.01)
        assert own.done
        assert own.result() == {"encoder": 7}
    assert number > 3, "the step has points to interrupt"
