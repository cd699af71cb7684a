"""Exchange messages on DDS with ROS 2's topic names, type names and QoS."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import cache
from typing import Any, NamedTuple
from xml.sax.saxutils import quoteattr

from cyclonedds.core import DDSException, Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct, make_idl_struct, types
from cyclonedds.internal import InvalidSample
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from cobotwire.capture.export.ros_messages import Message, fields_of, serialised
from cobotwire.protocol.errors import LinkError, UsageError

# How long a reader that does not acknowledge may delay a message; then the message is dropped.
BLOCKED_MS = 100
# The number of messages that ROS 2 keeps for a slow reader, unless a topic needs more.
DEPTH = 10
LOOPBACK = "127.0.0.1"
# The handle of a publisher has 64 bits.
HANDLES = 1 << 64
# Participants find each other only if they are configured alike. This is what ROS 2 gives Cyclone
# DDS for the range LOCALHOST: check_create_domain in rmw_node.cpp of rmw_cyclonedds_cpp.
_ON_THIS_COMPUTER = (
    "<General><AllowMulticast>false</AllowMulticast></General><Discovery>"
    "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>"
    '<Peers><Peer address="localhost"/></Peers></Discovery>'
)
_TYPES = {each: getattr(types, each) for each in ("byte", "int32", "uint32", "float64")}


class Network(NamedTuple):
    """Where other participants find ours: a name for users, and a Cyclone DDS configuration."""

    name: str
    configuration: str
    local: bool


def network(interface: str | None, environment: Mapping[str, str] = os.environ) -> Network:
    """Return the network of an interface (name or address), or the one that ROS 2's variables set.

    ``CYCLONEDDS_URI`` can change the configuration, as for ROS 2.

    Raises:
        UsageError: a variable has a value that is not allowed here.
    """
    only = _variable(environment, "ROS_LOCALHOST_ONLY", "0", "1")
    reach = ("LOCALHOST", "SUBNET", "SYSTEM_DEFAULT")
    found = _variable(environment, "ROS_AUTOMATIC_DISCOVERY_RANGE", *reach)
    if interface is None and only == "1":
        # This variable of ROS 2 Humble and older restricts traffic to the loopback interface.
        interface = LOOPBACK
    if interface is not None:
        key = "address" if interface.replace(".", "").isdigit() or ":" in interface else "name"
        chosen = f"<NetworkInterface {key}={quoteattr(interface)}/>"
        config = f"<General><Interfaces>{chosen}</Interfaces></General>"
        name, local = interface, interface in ("lo", LOOPBACK)
    elif found == "LOCALHOST" or not (found or only):
        name, config, local = "this computer", _ON_THIS_COMPUTER, True
    else:
        name, config, local = "the default network", "", False
    user = environment.get("CYCLONEDDS_URI", "")
    return Network(name, f"<CycloneDDS><Domain>{config}</Domain></CycloneDDS>,{user}", local)


class Participant:
    """Takes part in a domain as long as this object exists."""

    def __init__(self, domain: int, network: Network) -> None:
        """Join a domain.

        Raises:
            LinkError: the network interface does not exist.
        """
        try:
            # The domain is closed with this object.
            self._domain = Domain(domain, network.configuration)
            self._participant = DomainParticipant(domain)
        except DDSException as error:
            raise LinkError(
                f"DDS on {network.name}", "cannot be opened; Cyclone DDS says why"
            ) from error

    def publisher(self, topic: str, kind: str, depth: int = DEPTH) -> Callable[[Message], None]:
        """Return a function that publishes messages; DDS keeps ``depth`` for slow readers."""
        writer = DataWriter(self._participant, *self._topic(topic, kind, depth))

        def publish(message: Message) -> None:
            sample = object.__new__(struct_of(kind))
            sample.cdr = serialised(kind, message)
            with suppress(DDSException):
                writer.write(sample)

        return publish

    def reader(self, topic: str, kind: str) -> Reader:
        """Return a reader of the messages of a topic."""
        return Reader(DataReader(self._participant, *self._topic(topic, kind, DEPTH)))

    def _topic(self, topic: str, kind: str, depth: int) -> tuple[Topic[Any], Qos]:
        """Return a topic with ROS 2's usual QoS: reliable, and without copies for later readers."""
        qos = Qos(
            Policy.Reliability.Reliable(duration(milliseconds=BLOCKED_MS)),
            Policy.Durability.Volatile,
            Policy.History.KeepLast(depth),
            Policy.DataRepresentation(use_cdrv0_representation=True),
        )
        return Topic(self._participant, f"rt/{topic}", struct_of(kind), qos=qos), qos


class Received(NamedTuple):
    """A message and who sent it; the message is None if it is damaged."""

    message: Any
    sender: int


class Reader:
    """Receives the messages of a topic."""

    def __init__(self, reader: DataReader[Any]) -> None:
        self._reader = reader

    def publishes(self, sender: int) -> bool:
        """Return whether the sender of a message still publishes the topic."""
        # cyclonedds returns a handle as a signed number here, and as an unsigned one in a message.
        return any(each % HANDLES == sender for each in self._reader.get_matched_publications())

    def take(self) -> Iterator[Received]:
        """Yield the messages that came since the last call."""
        for _ in range(DEPTH):
            try:
                found = self._reader.take(1)
            except Exception:
                # Any program can be a participant, so the bytes may be damaged.
                yield Received(None, 0)
                return
            if not found:
                return
            if not isinstance(found[0], InvalidSample):
                yield Received(found[0], found[0].sample_info.publication_handle % HANDLES)


@cache
def struct_of(kind: str) -> type[IdlStruct]:
    """Return the DDS type of a message: ``sensor_msgs::msg::dds_::JointState_``, for example."""
    package, _, name = kind.split("/")
    fields = {}
    for field in fields_of(kind):
        one = str if field.kind == "string" else _TYPES.get(field.kind) or struct_of(field.kind)
        fields[field.name] = types.sequence[one] if field.many else one
    made: type[IdlStruct] = make_idl_struct(f"{name}_", f"{package}.msg.dds_.{name}_", fields)
    # The sample holds its bytes already: MCAP files and DDS use the same ones.
    made.serialize = lambda self, **options: self.cdr
    return made


def _variable(environment: Mapping[str, str], name: str, *allowed: str) -> str:
    value = environment.get(name, "")
    if value not in ("", *allowed):
        raise UsageError(name, value, ", ".join(allowed))
    return value
