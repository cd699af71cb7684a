"""What a difference between pymycobot's requests and ours is, how one is written down and read."""

from __future__ import annotations

from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec
from cobotwire.driver import Driver
from cobotwire.errors import ProtocolError, UsageError
from pymycobot_classes import REFUSALS, without_port, written

Arguments = tuple[Any, ...]

COBOT, M280, PALLETIZER = "MyCobot", "MyCobot280", "MyPalletizer260"
BOTH = (COBOT, M280)
NEWER = (M280, PALLETIZER)
ALL = (COBOT, M280, PALLETIZER)

# The topic of a command that a class says otherwise whatever its arguments are (zero apart, which
# is the same in every scale).
ALWAYS = "always"

# What ``becomes`` says where pymycobot raises before it writes.
NOT_SENT = "not sent"


class Difference(NamedTuple):
    """The same wish, as both sides say it.

    ``becomes`` is what an arm of this edition makes of pymycobot's bytes: the values that it reads,
    or the reason for which it refuses them.
    """

    ours: Arguments
    method: str
    theirs: Arguments
    becomes: Arguments | str
    ruling: str


class Row(NamedTuple):
    """A difference, and the classes that have it."""

    peers: tuple[str, ...]
    command: str
    topic: str
    difference: Difference


def same_call(
    peers: tuple[str, ...],
    command: str,
    topic: str,
    arguments: Arguments,
    becomes: Arguments | str,
    ruling: str,
) -> Row:
    """Both sides are called by the same name with the same arguments."""
    return Row(peers, command, topic, Difference(arguments, command, arguments, becomes, ruling))


def other_form(
    peers: tuple[str, ...],
    command: str,
    topic: str,
    ours: Arguments,
    method: str,
    theirs: Arguments,
    ruling: str,
) -> Row:
    """pymycobot is called otherwise, and its frame has a LEN that this edition does not know."""
    return Row(peers, command, topic, Difference(ours, method, theirs, "bad-length", ruling))


def said_by_us(client: Driver, command: str, difference: Difference) -> bytes | str:
    """What our client writes."""
    try:
        return written(client, command, difference.ours)
    except UsageError:
        return NOT_SENT


def said_by(peer: str, difference: Difference) -> bytes | str:
    """What one of pymycobot's classes writes."""
    try:
        return written(without_port(peer), difference.method, difference.theirs)
    except REFUSALS:
        return NOT_SENT


def read_by(codec: Codec, request: bytes | str) -> Arguments | str:
    """What an arm of the codec's edition makes of a request."""
    if isinstance(request, str):
        return request
    try:
        return codec.decode("request", request).values
    except ProtocolError as error:
        return error.reason
