"""A participant of ROS 2 that uses none of our code: types and bytes are those of rosbags."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from functools import cache
from typing import Any

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct, make_idl_struct, types
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_HUMBLE)
SCALARS: dict[str, Any] = {
    "string": str,
    "byte": types.byte,
    "int32": types.int32,
    "uint32": types.uint32,
    "float64": types.float64,
}
SECONDS = 10.0
# What rmw_cyclonedds_cpp gives Cyclone DDS for ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST.
LOCALHOST = (
    "<CycloneDDS><Domain><General><AllowMulticast>false</AllowMulticast></General>"
    "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
    "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>"
    '<Peers><Peer address="localhost"/></Peers></Discovery></Domain></CycloneDDS>,'
)


class Participant:
    """Takes part in a domain that exists in this process, or makes it."""

    def __init__(self, domain: int) -> None:
        self._participant = DomainParticipant(domain)

    def reader(self, topic: str, kind: str, depth: int = 10) -> DataReader[Any]:
        """Return a reader like that of a node of ROS 2."""
        return DataReader(self._participant, *self._topic(topic, kind, depth))

    def writer(self, topic: str, kind: str) -> DataWriter[Any]:
        """Return a writer like that of a node of ROS 2."""
        return DataWriter(self._participant, *self._topic(topic, kind, 10))

    def _topic(self, topic: str, kind: str, depth: int) -> tuple[Topic[Any], Qos]:
        qos = Qos(
            Policy.Reliability.Reliable(duration(infinite=True)),
            Policy.Durability.Volatile,
            Policy.History.KeepLast(depth),
            Policy.DataRepresentation(use_cdrv0_representation=True),
        )
        return Topic(self._participant, topic, struct(kind), qos=qos), qos


@cache
def struct(kind: str) -> type[IdlStruct]:
    """Return the type that ROS 2 gives a message; rosbags reads and writes its bytes."""
    package, _, name = kind.split("/")
    fields = {name: type_of(defined) for name, defined in STORE.fielddefs[kind][1]}
    made: Any = make_idl_struct(f"{name}_", f"{package}.msg.dds_.{name}_", fields)
    made.deserialize = classmethod(lambda cls, data: Received(STORE.deserialize_cdr(data, kind)))
    found: type[IdlStruct] = made
    return found


def type_of(defined: Any) -> Any:
    """Return the type of a field, as rosbags defines it."""
    node, value = defined
    if node.name == "SEQUENCE":
        return types.sequence[type_of(value[0])]
    return struct(value) if node.name == "NAME" else SCALARS[value[0]]


class Received:
    """A received message, in an object on which cyclonedds can set an attribute."""

    def __init__(self, message: Any) -> None:
        self.message = message


def sample(kind: str, data: bytes) -> Any:
    """Return a message that is sent as these bytes, even if they are malformed."""
    made: Any = object.__new__(struct(kind))
    made.serialize = lambda **options: data
    return made


async def received(
    reader: DataReader[Any], wanted: Callable[[Any], Any] = lambda each: each
) -> Any:
    """Call ``wanted`` with each received message; return its first result that is not empty."""
    until = time.monotonic() + SECONDS
    seen = None
    while time.monotonic() < until:
        taken = reader.take(1)
        if taken and isinstance(taken[0], Received) and (found := wanted(taken[0].message)):
            return found
        seen = taken[0] if taken else seen
        await asyncio.sleep(0 if taken else 0.005)
    raise AssertionError(
        f"the message did not arrive; the last one was: {getattr(seen, 'message', seen)}"
    )
