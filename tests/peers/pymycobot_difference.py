"""Record differences between pymycobot's requests and ours, and measure each."""

from __future__ import annotations

from typing import Any, NamedTuple

from cobotwire.client import Client
from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import ProtocolError, UsageError
from pymycobot_classes import REJECTIONS, without_port, written

Arguments = tuple[Any, ...]

COBOT, M280, PALLETIZER = "MyCobot", "MyCobot280", "MyPalletizer260"
BOTH = (COBOT, M280)
NEWER = (M280, PALLETIZER)
ALL = (COBOT, M280, PALLETIZER)

# The topic of a command that a class encodes differently for all arguments (except zero, which is
# the same in every scale).
ALWAYS = "always"

# The value of ``becomes`` if pymycobot raises before it writes.
NOT_SENT = "not sent"


class Difference(NamedTuple):
    """One intention, and the request that each side makes of it.

    ``becomes`` is what an arm of this edition decodes from pymycobot's bytes: the values, or the
    reason why it rejects them.
    """

    ours: Arguments
    method: str
    theirs: Arguments
    becomes: Arguments | str
    ruling: str


class Row(NamedTuple):
    """A difference and the classes that have it."""

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
    """Describe a difference where both sides have the same method and arguments."""
    return Row(peers, command, topic, Difference(arguments, command, arguments, becomes, ruling))


def other_variant(
    peers: tuple[str, ...],
    command: str,
    topic: str,
    ours: Arguments,
    method: str,
    theirs: Arguments,
    ruling: str,
) -> Row:
    """Describe a call of pymycobot that gives a frame with a LEN that this edition lacks."""
    return Row(peers, command, topic, Difference(ours, method, theirs, "bad-length", ruling))


def sent_by_us(client: Client, command: str, difference: Difference) -> bytes | str:
    """Return what our client writes."""
    try:
        return written(client, command, difference.ours)
    except UsageError:
        return NOT_SENT


def sent_by(peer: str, difference: Difference) -> bytes | str:
    """Return what one of pymycobot's classes writes."""
    try:
        return written(without_port(peer), difference.method, difference.theirs)
    except REJECTIONS:
        return NOT_SENT


def decoded_by(codec: Codec, request: bytes | str) -> Arguments | str:
    """Return the values that an arm of the codec's edition decodes, or the reason of rejection."""
    if isinstance(request, str):
        return request
    try:
        return codec.decode("request", request).values
    except ProtocolError as error:
        return error.reason
