"""An event, or a reply of another address, that precedes the reply does not end a request."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from typing import Any

import pytest

from cobotwire import MyBuddy
from cobotwire import codec as codecs
from cobotwire.cli.conform_client import read_script
from cobotwire.conformance.client import FAULTS, Referee, faulty_replies, possible_faults
from cobotwire.editions import mybuddy
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.protocol.errors import UsageError
from cobotwire.simulator import MemoryTransport, PtyServer, SteppedClock
from conformance.client.test_cases import failed
from trial_specs import HEAD, package_of

BUS = f"""
{HEAD}
joints: 0
frame:
  frame:
    header: FE FE
    check: sum
    length_counts: [command, data, check]
    addresses:
      LEFT: {{value: 1, doc: The left one.}}
      RIGHT: {{value: 2, doc: The right one.}}
    maximum_data: 16
    doc: FE FE ID LEN CMD DATA and a sum.
  transport: {{baudrate: 115200, deadline_ms: 500}}
types:
  wire:
    byte: {{bytes: 1, doc: A byte.}}
  quantities:
    number: {{wire: byte, range: [0, 9], doc: A number.}}
  texts:
    name: {{size: 3, doc: A name.}}
state:
  number: {{type: number}}
commands:
  set_number:
    {{id: 1, title: Set, doc: Sets., safety: setting, effect: {{stores: number}},
     request: [{{name: number, type: number}}]}}
  get_number:
    {{id: 2, title: Get, doc: Gets., safety: query, effect: {{reports: number}},
     reply: [{{name: number, type: number}}]}}
  get_name: {{id: 3, title: Get, doc: Gets., safety: query, reply: [{{name: name, type: name}}]}}
  get_register:
    {{id: 5, title: Get, doc: Gets., safety: query, request: [{{name: register, type: number}}],
     reply: [{{name: number, type: number}}]}}
  button_pressed:
    {{id: 4, title: Button, doc: A button was pressed., safety: query, event: true,
     reply: [{{name: number, type: number}}, {{name: name, type: name}}]}}
"""
OTHERS = ["event", "address"]


@pytest.fixture(scope="module")
def bus(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    with package_of(BUS, tmp_path_factory.mktemp("bus")) as package:
        yield package


def test_our_asyncio_client_delivers_replies_that_follow_other_messages(bus: Any) -> None:
    referee = Referee(bus.TABLE, scenario=faulty_replies(0.008, OTHERS, 1))

    async def calls(url: str) -> list[int]:
        async with bus.AsyncTrial(url, address=1, on_error="leave") as arm:
            return [await arm.get_number() for _ in range(4)]

    with PtyServer(referee) as server:
        assert asyncio.run(calls(server.url)) == [0] * 4
    assert failed(referee.finish()) == set()


@pytest.mark.parametrize("fault", OTHERS)
def test_client_that_takes_another_message_for_its_reply_fails(bus: Any, fault: str) -> None:
    clock, codec = SteppedClock(), codecs.load(bus.TABLE)
    referee = Referee(bus.TABLE, scenario=faulty_replies(0.008, [fault], 1), clock=clock)
    for name in ("get_number", "get_name", "get_number"):
        received = referee.receive(codec.encode(name, "request", (), address=1))
        while not received:
            clock.sleep(referee.wait or 0.001)
            received = referee.flush()
    clock.sleep(1.0)
    referee.flush()
    assert failed(referee.finish()) == {"reply-awaited"}


@pytest.mark.parametrize("meant", [1, 2])
def test_request_must_reach_the_address_of_the_script(bus: Any, meant: int) -> None:
    clock = SteppedClock()
    script = list(read_script(bus.TABLE, f"get_number --address {meant}\n", "calls"))
    referee = Referee(bus.TABLE, script=script, clock=clock)
    with bus.Trial(MemoryTransport(referee, clock), address=2, on_error="leave") as arm:
        arm.get_number()
    report = referee.finish()
    assert failed(report) == (set() if meant == 2 else {"sent-address"})
    if meant == 1:
        [failure] = report.failures
        assert "calls:1: address: expected LEFT, got RIGHT" in failure.reason


@pytest.mark.parametrize(("to", "failing"), [(1, {"late-reply-expected"}), (2, set())])
def test_late_reply_of_another_address_needs_no_wait(bus: Any, to: int, failing: set[str]) -> None:
    clock, codec = SteppedClock(), codecs.load(bus.TABLE)
    referee = Referee(bus.TABLE, scenario=faulty_replies(0.008, ["lost"], 1), clock=clock)
    # Both registers have the same id, and their replies differ only in the address.
    referee.receive(codec.encode("get_register", "request", (1,), address=1))
    clock.sleep(0.4)
    referee.flush()
    referee.receive(codec.encode("get_register", "request", (2,), address=to))
    assert failed(referee.finish()) == failing


@pytest.mark.parametrize(("moved", "failing"), [("LEFT", {"motion-powered"}), ("RIGHT", set())])
def test_each_device_has_power_of_its_own(moved: str, failing: set[str]) -> None:
    clock = SteppedClock()
    referee = Referee(mybuddy.TABLE, clock=clock)
    with MyBuddy(MemoryTransport(referee, clock), address="LEFT", on_error="leave") as left:
        left.power_off()
        getattr(left, moved.lower()).send_angle(1, 10, 50)
    assert failed(referee.finish()) == failing


def test_faults_that_an_edition_cannot_have_are_refused(bus: Any) -> None:
    assert set(possible_faults(bus.TABLE)) == set(FAULTS)
    assert set(possible_faults(TABLE)) == set(FAULTS) - set(OTHERS)
    with pytest.raises(UsageError, match="the edition mycobot280 has no events"):
        Referee(TABLE, scenario=faulty_replies(0.0, ["event"]))
    with pytest.raises(UsageError, match="has no second address"):
        Referee(TABLE, scenario=faulty_replies(0.0, ["address"]))
