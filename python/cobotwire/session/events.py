"""What the session makes of received bytes, and the traffic that listeners see."""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

from cobotwire.codec.interface import Codec, DecodedMessage, Frame, Noise
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Command


class ReplyMatched(NamedTuple):
    """The reply that was waited for.

    ``message`` is None where the reply was text outside any frame. ``frame`` is None where an
    earlier event has reported the bytes: text as noise, a copy as :class:`EchoReceived`.
    """

    command: Command
    fields: dict[str, Any]
    message: DecodedMessage | None
    frame: Frame | None = None


class ReplyRejected(NamedTuple):
    """The reply that was waited for came, but the edition does not allow its values."""

    command: Command
    error: ProtocolError
    frame: Frame | None = None


class LateReply(NamedTuple):
    """The reply to a request that was given up, or to an earlier attempt of one that has ended."""

    command: Command
    frame: Frame


class AckReceived(NamedTuple):
    """The acknowledgement of a one-way request."""

    command: Command
    message: DecodedMessage
    frame: Frame


class EventReceived(NamedTuple):
    """A message that the device sends without a request."""

    command: Command
    message: DecodedMessage
    frame: Frame


class UnexpectedFrame(NamedTuple):
    """A legal frame that replies to nothing."""

    frame: Frame


class EchoReceived(NamedTuple):
    """The request's own bytes: an echo, or a reply that looks the same.

    The bytes that follow decide which it is; see :mod:`cobotwire.session.echo`.
    """

    frame: Frame


class RequestExpired(NamedTuple):
    """The deadline passed; the request was sent ``attempts`` times, first at ``requested_at``."""

    command: Command
    requested_at: float
    attempts: int = 1


FrameEvent = AckReceived | EventReceived | LateReply | UnexpectedFrame | EchoReceived
SessionEvent = ReplyMatched | ReplyRejected | AckReceived | RequestExpired | FrameEvent | Noise


class Traffic(NamedTuple):
    """One frame, text or span of noise that went over the line.

    Every received byte stands in exactly one of these, in the order of the line. A sent frame is
    reported when it has been written.

    Attributes:
        time: seconds of ``time.monotonic()``: after the write, or when the last byte was read.
        direction: ``sent`` or ``received``.
        data: a frame (with the text that follows some), or a span of noise.
        event: what the session makes of it; None for what is sent.
    """

    time: float
    direction: Literal["sent", "received"]
    data: bytes
    event: SessionEvent | None = None


def sent_command(traffic: Traffic, codec: Codec) -> Command | None:
    """Return the command of a request that was sent; None: the traffic is something else."""
    if traffic.direction != "sent":
        return None
    try:
        return codec.decode("request", traffic.data).command
    except ProtocolError:
        return None


def as_traffic(event: SessionEvent, now: float) -> Traffic | None:
    """Return an event as traffic; None where its bytes were reported before, or it has none."""
    if isinstance(event, Noise):
        return Traffic(now, "received", event.data, event)
    if isinstance(event, RequestExpired) or event.frame is None:
        return None
    return Traffic(now, "received", event.frame.data, event)
