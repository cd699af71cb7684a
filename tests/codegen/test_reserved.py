"""The reserved names are those of the classes that the generated classes extend."""

from __future__ import annotations

from cobotwire.client.aio_moving import AsyncMovingClient
from cobotwire.client.moving import MovingClient
from cobotwire.editions.mycobot280 import TABLE, AsyncMyCobot280, MyCobot280
from cobotwire.protocol.messages import Reply, Request
from cobotwire.simulator import MemoryTransport, RunningClock, SimulatedArm
from cobotwire_codegen.check.reserved import (
    RESERVED_COMMANDS,
    RESERVED_FIELDS,
    RESERVED_ITEMS,
)


def _public(*names: object) -> set[str]:
    return {str(name) for name in names if not str(name).startswith("_")}


def test_reserved_commands_are_the_attributes_of_the_clients() -> None:
    classes = _public(*dir(MovingClient), *dir(AsyncMovingClient))
    clock = RunningClock()
    with MyCobot280(MemoryTransport(SimulatedArm(TABLE, clock=clock), clock)) as arm:
        instance = _public(*vars(arm))
    waiting = _public(*vars(AsyncMyCobot280("/dev/null")))
    needed = classes | instance | waiting | {"table"}
    assert needed <= RESERVED_COMMANDS
    annotations = {"bool", "bytes", "float", "int", "str", "tuple"}
    assert RESERVED_COMMANDS - needed - annotations == set()


def test_reserved_fields_are_the_attributes_of_the_messages() -> None:
    assert _public(*dir(Request), *dir(Reply), *Request.__annotations__) <= RESERVED_FIELDS
    assert _public(*dir(Reply), *Reply.__annotations__) <= RESERVED_FIELDS


def test_reserved_items_are_the_attributes_of_tuples() -> None:
    assert _public(*dir(tuple)) <= RESERVED_ITEMS
