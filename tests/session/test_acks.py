"""A lost acknowledgement causes doubt for a while; none counts for another request."""

from __future__ import annotations

from typing import Any

import pytest

from cobotwire import ProtocolError, ReplyTimeout
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.session import AckReceived, Exchange, PendingAck
from cobotwire.session.acks import MOTION_SECONDS
from cobotwire.session.pending import GRACE_SECONDS
from cobotwire.session.request import RequestEncoder

SETTING = ("set_color", (1, 2, 3))
MOTION = ("send_angle", (1, 10, 50))
PROMPT = 0.008
WITHIN = 0.5


class AckedArm:
    """An exchange with an arm that acknowledges each request 8 ms later, unless it is lost."""

    def __init__(self, codec: Codec, name: str, values: tuple[Any, ...]) -> None:
        self._exchange = Exchange(codec)
        self._request = RequestEncoder(codec).encode(name, values)
        self._ack = codec.encode(name, "reply", (1,))

    def send(self, at: float, lost: bool = False, ack: bytes | None = None) -> PendingAck:
        """Send the request, and let the time pass for which its caller waits."""
        _, pending = self._exchange.send_one_way(self._request, at, WITHIN)
        assert pending is not None
        if not lost:
            self._exchange.receive(self._ack if ack is None else ack, at + PROMPT)
        self._exchange.wake(at + WITHIN)
        assert pending.done
        return pending

    def succeeds(self, at: float, lost: bool = False) -> bool:
        """Return whether the caller got its acknowledgement."""
        try:
            self.send(at, lost).result()
        except ReplyTimeout:
            return False
        return True


@pytest.fixture
def loaded(codec: Codec) -> Codec:
    return codecs.load(TABLE, codec.name)


def test_setter_succeeds_again_once_the_lost_acknowledgement_cannot_come(loaded: Codec) -> None:
    arm = AckedArm(loaded, *SETTING)
    assert arm.succeeds(0.0)
    assert not arm.succeeds(10.0, lost=True)
    assert not arm.succeeds(10.0 + GRACE_SECONDS - 0.1), "it may be that of the earlier request"
    assert arm.succeeds(12.0)


def test_motions_succeed_again_after_one_lost_acknowledgement(loaded: Codec) -> None:
    arm = AckedArm(loaded, *MOTION)
    assert arm.succeeds(0.0), "this firmware acknowledges motions at once"
    results = [arm.succeeds(5.0 * number, lost=number == 1) for number in range(1, 200)]
    assert results == [False] + [True] * 198


def test_motions_succeed_again_if_the_very_first_acknowledgement_was_lost(loaded: Codec) -> None:
    arm = AckedArm(loaded, *MOTION)
    results = {5.0 * number: arm.succeeds(5.0 * number, lost=number == 0) for number in range(40)}
    assert not any(result for at, result in results.items() if at < MOTION_SECONDS)
    assert all(result for at, result in results.items() if at > MOTION_SECONDS + 10)


def test_late_acknowledgement_of_a_motion_does_not_acknowledge_the_next(loaded: Codec) -> None:
    arm = AckedArm(loaded, *MOTION)
    exchange = arm._exchange
    first = arm.send(0.0, lost=True)
    with pytest.raises(ReplyTimeout):
        first.result()
    # The first motion ends 20 s later, when the next one has been sent.
    _, second = exchange.send_one_way(arm._request, 20.0, WITHIN)
    exchange.receive(arm._ack, 20.1)
    exchange.wake(20.5)
    assert second is not None
    with pytest.raises(ReplyTimeout, match="acknowledgement of send_angle, perhaps of an earlier"):
        second.result()


def test_acknowledgement_that_begins_before_its_deadline_counts(loaded: Codec) -> None:
    exchange, ack = Exchange(loaded), loaded.encode(SETTING[0], "reply", (1,))
    exchange.send_one_way(RequestEncoder(loaded).encode(*SETTING), 0.0, None)
    exchange.receive(ack[:3], GRACE_SECONDS - 0.01)
    [event] = exchange.receive(ack[3:], GRACE_SECONDS + 0.01)
    assert isinstance(event, AckReceived)


def test_acknowledgement_of_0_is_an_error(loaded: Codec) -> None:
    arm = AckedArm(loaded, *SETTING)
    pending = arm.send(0.0, ack=loaded.encode("set_color", "reply", (0,)))
    with pytest.raises(ProtocolError, match=r"did not carry out set_color\(.*\): done is 0"):
        pending.result()
