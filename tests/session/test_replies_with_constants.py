"""Replies of one id are distinguished only by a constant, as on a bus of grippers."""

from __future__ import annotations

from typing import Any

import pytest

import small_specs
from cobotwire import ReplyTimeout
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.protocol.loading import load_table
from cobotwire.session import LateReply, ReplyMatched, ReplyRejected, UnexpectedFrame
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock
from cobotwire_codegen.check import check
from session.one_caller import OneCaller

COMMANDS = """
get_force:
  id: 0xE9
  title: Read the force
  doc: Reads the force.
  safety: query
  request:
    - {name: gripper, type: small}
    - {name: register, type: small, const: 10}
  reply:
    - {name: gripper, type: small, echo: required}
    - {name: register, type: small, const: 10}
    - {name: force, type: percent}
get_state:
  id: 0xE9
  shares_id: get_force
  title: Read the state
  doc: Reads the state.
  safety: query
  request:
    - {name: gripper, type: small}
    - {name: register, type: small, const: 11}
  reply:
    - {name: gripper, type: small, echo: required}
    - {name: register, type: small, const: 11}
    - {name: state, type: mode}
"""
VECTORS = """
- {name: a, command: get_force, direction: request, frame: FE FE 04 E9 0E 0A FA, values: {gripper: 14, register: 10}}
- {name: b, command: get_state, direction: request, frame: FE FE 04 E9 0E 0B FA, values: {gripper: 14, register: 11}}
- {name: c, command: get_force, direction: reply, frame: FE FE 05 E9 0E 0A 32 FA, values: {gripper: 14, register: 10, force: 50}}
- {name: d, command: get_state, direction: reply, frame: FE FE 05 E9 0E 0B 01 FA, values: {gripper: 14, register: 11, state: BLINK}}
"""  # noqa: E501  (a vector is one line)
FORCE = bytes.fromhex("FE FE 05 E9 0E 0A 32 FA")
STATE = bytes.fromhex("FE FE 05 E9 0E 0B 01 FA")
ILLEGAL_STATE = bytes.fromhex("FE FE 05 E9 0E 0B 07 FA")
ILLEGAL_FORCE = bytes.fromhex("FE FE 05 E9 0E 0A FF FA")


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Any:
    folder = tmp_path_factory.mktemp("spec")
    edition = small_specs.build(folder, COMMANDS, VECTORS)
    check(edition)
    return small_specs.package(folder, edition)


@pytest.fixture(params=["reference", "native"])
def loaded(request: pytest.FixtureRequest, package: Any, repeated_in_rust: None) -> Codec:
    return codecs.load(load_table(package.__name__, None), request.param)


def kinds(events: list[Any]) -> list[type]:
    return [type(event) for event in events]


def test_reply_is_decoded_as_the_command_whose_constant_it_has(loaded: Codec) -> None:
    assert loaded.decode("reply", FORCE).command.name == "get_force"
    assert loaded.decode("reply", STATE).command.name == "get_state"


@pytest.mark.parametrize("foreign", [STATE, ILLEGAL_STATE])
def test_reply_with_the_constant_of_another_command_does_not_end_the_request(
    loaded: Codec, foreign: bytes
) -> None:
    session = OneCaller(loaded)
    session.request("get_force", (14, 10), now=0.0)
    assert kinds(session.receive(foreign, 0.01)) == [UnexpectedFrame]
    assert session.waiting
    [matched] = session.receive(FORCE, 0.02)
    assert isinstance(matched, ReplyMatched)
    assert matched.fields == {"gripper": 14, "register": 10, "force": 50}


def test_illegal_value_after_the_own_constant_ends_the_request(loaded: Codec) -> None:
    session = OneCaller(loaded)
    session.request("get_force", (14, 10), now=0.0)
    assert kinds(session.receive(ILLEGAL_FORCE, 0.01)) == [ReplyRejected]


def test_illegal_value_ends_no_request_while_another_reply_is_outstanding(loaded: Codec) -> None:
    session = OneCaller(loaded)
    session.request("get_force", (15, 10), now=0.0, timeout=0.1)
    session.wake(0.1)
    assert session.request("get_force", (14, 10), now=0.1)
    assert kinds(session.receive(ILLEGAL_FORCE, 0.15)) == [UnexpectedFrame]
    assert session.waiting


def test_constant_that_no_command_of_the_id_has_ends_the_request(loaded: Codec) -> None:
    *others, state = loaded.table.commands
    apart = loaded.table._replace(commands=(*others, state._replace(id=0xEA)))
    session = OneCaller(codecs.load(apart, loaded.name))
    session.request("get_force", (14, 10), now=0.0)
    assert kinds(session.receive(STATE, 0.01)) == [ReplyRejected]


def test_outstanding_reply_does_not_hold_a_request_that_its_constant_excludes(
    loaded: Codec,
) -> None:
    session = OneCaller(loaded)
    session.request("get_force", (14, 10), now=0.0, timeout=0.1)
    session.wake(0.1)
    assert session.request("get_force", (14, 10), now=0.2) == b"", "it could take the late reply"
    session.give_up()
    assert session.request("get_state", (14, 11), now=0.2)
    assert kinds(session.receive(FORCE, 0.3)) == [LateReply]
    assert session.waiting
    assert kinds(session.receive(STATE, 0.4)) == [ReplyMatched]


class Swapping(SimulatedArm):
    """An arm that gives each of two queries the reply to the other query."""

    def receive(self, data: bytes) -> bytes:
        other = {10: 11, 11: 10}[data[5]]
        return super().receive(data[:5] + bytes([other]) + data[6:])


def test_clients_read_both_values_and_accept_no_swapped_reply(package: Any) -> None:
    clock = SteppedClock()
    with package.CLIENT(MemoryTransport(SimulatedArm(package.TABLE, clock=clock), clock)) as arm:
        assert arm.get_force(14) == 1
        assert arm.get_state(14) is package.Mode.STEADY
    clock = SteppedClock()
    with package.CLIENT(MemoryTransport(Swapping(package.TABLE, clock=clock), clock)) as arm:
        for method in (arm.get_force, arm.get_state):
            with pytest.raises(ReplyTimeout):
                method(14)
