"""The exchange keeps its guarantees for callers that share a transport."""

from __future__ import annotations

import pytest

from cobotwire import codec as codecs
from cobotwire.client.opening import settings
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot import TABLE
from cobotwire.editions.mycobot280 import TABLE as TABLE_280
from cobotwire.protocol.errors import LinkError, ReplyTimeout, UsageError
from cobotwire.session import EncodedRequest, Exchange, PendingRequest, RetryPolicy
from cobotwire.session.request import RequestEncoder

ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
QUERY_ANGLES = bytes.fromhex("FE FE 02 20 FA")
QUERY_POWER = bytes.fromhex("FE FE 02 12 FA")
THREE = RetryPolicy()
ONCE = RetryPolicy(attempts=1)


@pytest.fixture
def exchange(codec: Codec) -> Exchange:
    return Exchange(codec)


@pytest.fixture(params=["reference", "native"])
def exchange_280(request: pytest.FixtureRequest) -> Exchange:
    """Return an exchange of the edition with acknowledgements."""
    return Exchange(codecs.load(TABLE_280, request.param))


def encode(name: str, values: tuple[int, ...]) -> EncodedRequest:
    return RequestEncoder(codecs.load(TABLE, "reference")).encode(name, values)


def encode_280(name: str, values: tuple[int, ...]) -> EncodedRequest:
    return RequestEncoder(codecs.load(TABLE_280, "reference")).encode(name, values)


def submit(exchange: Exchange, name: str, *values: int, now: float = 0.0) -> PendingRequest:
    """Submit a request that both editions have."""
    pending = PendingRequest(encode(name, values), None, THREE, now)
    exchange.enqueue(pending)
    return pending


def test_requests_take_turns_in_the_order_of_submission(exchange: Exchange) -> None:
    first, second = submit(exchange, "get_angles"), submit(exchange, "is_power_on")
    assert exchange.outgoing(0.0, drained=True) == QUERY_ANGLES
    assert exchange.outgoing(0.0, drained=True) == b""
    exchange.receive(ANGLES, 0.01)
    assert first.done
    assert first.result()["angles"][0] == 1.4
    assert exchange.outgoing(0.01, drained=True) == QUERY_POWER
    exchange.receive(POWERED, 0.02)
    assert second.result() == {"powered": 1}
    assert exchange.idle_seconds(0.02) is None


def test_query_is_sent_at_even_intervals_until_its_deadline(exchange: Exchange) -> None:
    pending = submit(exchange, "get_angles")
    sent = [0.0] if exchange.outgoing(0.0, drained=True) else []
    now = 0.0
    while not pending.done:
        wait = exchange.idle_seconds(now)
        assert wait is not None
        now += wait
        exchange.wake(now)
        if exchange.outgoing(now, drained=True):
            sent.append(now)
    assert sent == pytest.approx([0.0, 0.5 / 3, 1.0 / 3])
    assert now == pytest.approx(0.5)
    with pytest.raises(ReplyTimeout, match=r"get_angles\(\) within 0\.500 s after 3 attempts"):
        pending.result()


@pytest.mark.parametrize(
    ("wait", "attempts"), [(0.05, 1), (0.19, 1), (0.2, 2), (0.3, 3), (0.5, 3), (3.0, 3)]
)
def test_short_deadline_is_split_into_fewer_attempts(wait: float, attempts: int) -> None:
    assert THREE.attempts_of(TABLE.command("get_angles"), wait) == attempts


def test_only_queries_are_ever_repeated() -> None:
    policy = RetryPolicy(attempts=9)
    for table in (TABLE, TABLE_280):
        for command in table.commands:
            again = policy.attempts_of(command, 10.0) > 1
            assert again == (command.safety == "query" and command.text is None), command.name


@pytest.mark.parametrize(
    "wrong",
    [
        {"attempts": 0},
        {"attempts": 1.5},
        {"attempts": True},
        {"shortest_attempt": 0},
        {"grace": -1},
    ],
)
def test_policy_error_names_the_wrong_value(wrong: dict[str, float]) -> None:
    with pytest.raises(UsageError, match=f"retry.{next(iter(wrong))}"):
        RetryPolicy(**wrong)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match=f"retry.{next(iter(wrong))}"):
        settings(TABLE, None, RetryPolicy()._replace(**wrong), None, None)  # type: ignore[arg-type]


def test_one_way_request_is_sent_at_once_while_another_request_waits(exchange: Exchange) -> None:
    pending = submit(exchange, "get_angles")
    exchange.outgoing(0.0, drained=True)
    data, ack = exchange.send_one_way(encode("stop", ()), 0.01)
    assert data == bytes.fromhex("FE FE 02 29 FA")
    assert ack is None
    exchange.receive(ANGLES, 0.02)
    assert pending.done


def test_echo_of_a_one_way_request_does_not_hide_the_echo_of_the_request(
    exchange: Exchange,
) -> None:
    pending = submit(exchange, "is_servo_enable", 1)
    first_request = exchange.outgoing(0.0, drained=True)
    sent_one_way, _ = exchange.send_one_way(encode("stop", ()), 0.01)
    exchange.receive(first_request + sent_one_way, 0.02)
    assert not pending.done, "the first copy of the request is its echo"


def test_held_request_is_overtaken_by_a_request_that_is_not_held(exchange: Exchange) -> None:
    lost = submit(exchange, "get_encoder", 1)
    exchange.outgoing(0.0, drained=True)
    exchange.give_up(lost)
    held, free = submit(exchange, "get_encoder", 2), submit(exchange, "is_power_on")
    assert exchange.outgoing(0.1, drained=True) == QUERY_POWER
    exchange.receive(POWERED, 0.2)
    assert free.done
    assert exchange.outgoing(0.3, drained=True) == b""
    assert exchange.idle_seconds(0.3) == pytest.approx(0.7)
    assert exchange.outgoing(1.0, drained=True) == bytes.fromhex("FE FE 03 3B 02 FA")
    assert not held.done


def test_outstanding_reply_of_a_repeated_request_holds_the_next_one(
    exchange: Exchange,
) -> None:
    pending = submit(exchange, "get_angles")
    exchange.outgoing(0.0, drained=True)
    assert exchange.outgoing(0.2, drained=True) == QUERY_ANGLES
    exchange.receive(ANGLES, 0.3)
    assert pending.done
    again = submit(exchange, "get_angles", now=0.3)
    assert exchange.outgoing(0.3, drained=True) == b"", (
        "the outstanding reply would look like its own"
    )
    exchange.receive(ANGLES, 0.35)
    assert not again.done
    assert exchange.outgoing(1.19, drained=True) == b"", "what came may have been a copy"
    assert exchange.outgoing(1.2, drained=True) == QUERY_ANGLES


def test_grace_of_the_policy_ends_the_hold(exchange: Exchange) -> None:
    for attempt in range(2):
        policy = RetryPolicy(attempts=2, grace=0.1)
        exchange.enqueue(PendingRequest(encode("get_angles", ()), 0.4, policy, 0.0))
        assert attempt or exchange.outgoing(0.0, drained=True)
    exchange.outgoing(0.2, drained=True)
    exchange.receive(ANGLES, 0.21)
    assert exchange.outgoing(0.29, drained=True) == b""
    assert exchange.outgoing(0.31, drained=True) == QUERY_ANGLES


def test_request_is_sent_after_60_ms_on_a_line_that_is_never_drained(exchange: Exchange) -> None:
    submit(exchange, "get_angles")
    assert exchange.outgoing(0.0, drained=False) == b""
    assert exchange.outgoing(0.06, drained=False) == QUERY_ANGLES


def test_lost_transport_ends_every_request(exchange_280: Exchange) -> None:
    first_request, queued = submit(exchange_280, "get_angles"), submit(exchange_280, "is_power_on")
    exchange_280.outgoing(0.0, drained=True)
    _, ack = exchange_280.send_one_way(encode_280("stop", ()), 0.0, ack_within=1.0)
    exchange_280.fail(LinkError("port", "is gone"), 0.1)
    assert ack is not None
    for pending in (first_request, queued, ack):
        with pytest.raises(LinkError, match="port: is gone"):
            pending.result()


def test_missing_acknowledgement_is_a_timeout(exchange_280: Exchange) -> None:
    _, pending = exchange_280.send_one_way(encode_280("set_color", (1, 2, 3)), 0.0, ack_within=0.5)
    exchange_280.receive(b"cmd_len error", 0.2)
    exchange_280.wake(0.5)
    assert pending is not None
    with pytest.raises(ReplyTimeout, match=r"set_color\(red=1, green=2, blue=3\).*63 6D 64"):
        pending.result()


def test_first_acknowledgement_does_not_confirm_the_second_of_two_equal_requests(
    exchange_280: Exchange,
) -> None:
    request = encode_280("set_color", (1, 2, 3))
    exchange_280.send_one_way(request, 0.0)
    _, second = exchange_280.send_one_way(request, 0.1, ack_within=0.5)
    assert second is not None
    exchange_280.receive(bytes.fromhex("FE FE 03 6A 01 FA"), 0.2)
    assert not second.done
    exchange_280.receive(bytes.fromhex("FE FE 03 6A 01 FA"), 0.3)
    assert second.done


def test_copy_that_may_be_an_echo_counts_as_acknowledgement_at_the_deadline(
    exchange_280: Exchange,
) -> None:
    data, pending = exchange_280.send_one_way(encode_280("stop", ()), 0.0, ack_within=0.5)
    exchange_280.receive(data, 0.1)
    assert pending is not None
    assert not pending.done
    exchange_280.wake(0.5)
    pending.result()
