"""An acknowledgement counts for no other request; acknowledgement 0 is an error.

``test_explored.py`` holds the other promises about acknowledgements.
"""

from __future__ import annotations

from typing import Any

import pytest

from cobotwire import ProtocolError, ReplyTimeout
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.session import AckReceived, Exchange, PendingAck, UnexpectedFrame
from cobotwire.session.acks import MOTION_SECONDS
from cobotwire.session.pending import GRACE_SECONDS
from cobotwire.session.request import RequestEncoder

pytestmark = pytest.mark.usefixtures("repeated_in_rust")
SETTING = ("set_color", (1, 2, 3))
MOTION = ("send_angle", (1, 10, 50))
WITHIN = 0.5


def sent(
    exchange: Exchange, codec: Codec, at: float, ack: bytes, name: str, *values: Any
) -> PendingAck:
    """Send a request, receive ``ack`` a little later, and wait for the acknowledgement."""
    _, pending = exchange.send_one_way(RequestEncoder(codec).encode(name, values), at, WITHIN)
    exchange.receive(ack, at + 0.1)
    exchange.wake(at + WITHIN)
    assert pending is not None
    return pending


@pytest.fixture
def loaded(codec: Codec) -> Codec:
    return codecs.load(TABLE, codec.name)


def test_late_acknowledgement_of_a_motion_does_not_acknowledge_the_next(loaded: Codec) -> None:
    exchange, ack = Exchange(loaded), loaded.encode("send_angle", "reply", (1,))
    with pytest.raises(ReplyTimeout):
        sent(exchange, loaded, 0.0, b"", "send_angle", 1, 10, 50).result()
    # The first motion ends 20 s later, when the next one has been sent.
    second = sent(exchange, loaded, 20.0, ack, "send_angle", 1, 10, 50)
    with pytest.raises(ReplyTimeout, match="acknowledgement of send_angle, perhaps of an earlier"):
        second.result()


@pytest.mark.parametrize(("named", "seconds"), [(SETTING, GRACE_SECONDS), (MOTION, MOTION_SECONDS)])
def test_acknowledgement_counts_until_its_time_is_over(
    loaded: Codec, named: tuple[str, Any], seconds: float
) -> None:
    request, ack = RequestEncoder(loaded).encode(*named), loaded.encode(named[0], "reply", (1,))
    for at, kind in ((seconds - 0.05, AckReceived), (seconds, UnexpectedFrame)):
        exchange = Exchange(loaded)
        exchange.send_one_way(request, 0.0)
        [event] = exchange.receive(ack, at)
        assert type(event) is kind


def test_acknowledgement_of_0_is_an_error(loaded: Codec) -> None:
    refused = loaded.encode("set_color", "reply", (0,))
    pending = sent(Exchange(loaded), loaded, 0.0, refused, "set_color", 1, 2, 3)
    with pytest.raises(ProtocolError, match=r"did not carry out set_color\(.*\): done is 0"):
        pending.result()
