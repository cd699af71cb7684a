"""An acknowledgement counts only for its own request, and only until its time is over.

``test_explored.py`` and ``test_rust_exchange.py`` check the other rules of acknowledgements.
"""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import small_specs
from cobotwire import ReplyTimeout
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.session import AckReceived, Exchange, UnexpectedFrame
from cobotwire.session.acks import MOTION_SECONDS
from cobotwire.session.pending import GRACE_SECONDS
from cobotwire.session.request import RequestEncoder

pytestmark = pytest.mark.usefixtures("repeated_in_rust")
# As on a bus: a constant and an argument distinguish acknowledgements of one id.
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
REQUESTS = st.tuples(st.sampled_from(sorted(REGISTERS)), st.sampled_from([14, 15]))


@pytest.fixture(scope="module", params=["reference", "native"])
def bus(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> Codec:
    """Return the codec of grippers on a bus."""
    folder = tmp_path_factory.mktemp("spec")
    commands = ""
    for name, register in REGISTERS.items():
        sharing = "" if not commands else "shares_id: set_force"
        commands += COMMAND.format(name=name, register=register, sharing=sharing)
    package = small_specs.package(folder, small_specs.build(folder, commands))
    return codecs.load(package.TABLE, request.param)


@given(sent=st.lists(st.tuples(REQUESTS, st.booleans()), min_size=1, max_size=8))
def test_request_never_succeeds_by_the_ack_of_another_one(bus: Codec, sent: list[Any]) -> None:
    exchange, encoder, waiting = Exchange(bus), RequestEncoder(bus), []
    for number, ((name, gripper), acknowledged) in enumerate(sent):
        request = encoder.encode(name, (gripper, REGISTERS[name], 50))
        _, pending = exchange.send_one_way(request, 0.01 * number, 0.5)
        waiting.append((pending, (name, gripper), acknowledged))
    for (name, gripper), acknowledged in sent:
        if acknowledged:
            exchange.receive(bus.encode(name, "reply", (gripper, REGISTERS[name], 1)), 0.1)
    exchange.wake(1.0)
    for pending, key, _ in waiting:
        assert pending is not None
        if not all(acknowledged for _, other, acknowledged in waiting if other == key):
            with pytest.raises(ReplyTimeout):
                pending.result()


@pytest.mark.parametrize(
    ("name", "values", "seconds"),
    [("set_color", (1, 2, 3), GRACE_SECONDS), ("send_angle", (1, 10, 50), MOTION_SECONDS)],
)
def test_acknowledgement_counts_until_its_time_is_over(
    codec: Codec, name: str, values: tuple[Any, ...], seconds: float
) -> None:
    loaded = codecs.load(TABLE, codec.name)
    request, ack = RequestEncoder(loaded).encode(name, values), loaded.encode(name, "reply", (1,))
    for at, kind in ((seconds - 0.05, AckReceived), (seconds, UnexpectedFrame)):
        exchange = Exchange(loaded)
        exchange.send_one_way(request, 0.0)
        [event] = exchange.receive(ack, at)
        assert type(event) is kind
