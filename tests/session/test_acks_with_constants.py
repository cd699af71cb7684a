"""Acknowledgements of one id are distinguished by a constant or an argument, as on a bus."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import small_specs
from cobotwire import ReplyTimeout
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.session import Exchange, PendingAck
from cobotwire.session.request import RequestEncoder

pytestmark = pytest.mark.usefixtures("repeated_in_rust")
REGISTERS = {"set_force": 10, "set_speed": 11, "set_torque": 12}
COMMAND = """
{name}:
  id: 0xE9
  {sharing}
  title: Set a register
  doc: Sets a register.
  safety: setting
  ack: true
  request:
    - {{name: gripper, type: small}}
    - {{name: register, type: small, const: {register}}}
    - {{name: value, type: percent}}
  reply:
    - {{name: gripper, type: small, echo: required}}
    - {{name: register, type: small, const: {register}}}
    - {{name: done, type: flag}}
"""
QUERY = """
get_done:
  id: 0xE9
  shares_id: set_force
  title: Read whether it is done
  doc: Reads a flag.
  safety: query
  reply: [{name: done, type: flag}]
"""
WITHIN = 0.5
GRIPPERS = (14, 15)


@pytest.fixture(scope="module", params=["reference", "native"])
def loaded(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> Codec:
    folder = tmp_path_factory.mktemp("spec")
    commands = ""
    for name, register in REGISTERS.items():
        sharing = "" if not commands else "shares_id: set_force"
        commands += COMMAND.format(name=name, register=register, sharing=sharing)
    package = small_specs.package(folder, small_specs.build(folder, commands + QUERY))
    return codecs.load(package.TABLE, request.param)


class Bus:
    """An exchange with grippers on a bus; the test chooses the requests that they acknowledge."""

    def __init__(self, codec: Codec) -> None:
        self._codec, self._encoder = codec, RequestEncoder(codec)
        self.exchange = Exchange(codec)

    def send(self, key: tuple[str, int], at: float) -> PendingAck:
        name, gripper = key
        values = (gripper, REGISTERS[name], 50)
        request = self._encoder.encode(name, values)
        _, pending = self.exchange.send_one_way(request, at, WITHIN)
        assert pending is not None
        return pending

    def acknowledge(self, key: tuple[str, int], at: float) -> None:
        name, gripper = key
        frame = self._codec.encode(name, "reply", (gripper, REGISTERS[name], 1))
        self.exchange.receive(frame, at)


def succeeds(pending: PendingAck) -> bool:
    try:
        pending.result()
    except ReplyTimeout:
        return False
    return True


REQUESTS = st.tuples(st.sampled_from(sorted(REGISTERS)), st.sampled_from(GRIPPERS))


@given(sent=st.lists(st.tuples(REQUESTS, st.booleans()), min_size=1, max_size=8))
def test_request_never_succeeds_by_the_ack_of_another_one(loaded: Codec, sent: list[Any]) -> None:
    bus = Bus(loaded)
    waiting = [(bus.send(key, 0.01 * at), key, comes) for at, (key, comes) in enumerate(sent)]
    for key, comes in sent:
        if comes:
            bus.acknowledge(key, 0.1)
    bus.exchange.wake(1.0)
    for pending, key, _ in waiting:
        alike = [comes for _, other, comes in waiting if other == key]
        assert not succeeds(pending) or all(alike)


def test_requests_do_not_collect_outstanding_replies(loaded: Codec) -> None:
    bus = Bus(loaded)
    for number in range(100):
        bus.send(("set_force", 14), 2.0 * number)
    assert len(bus.exchange._outstanding.replies) == 1
