"""Decode the frames of a capture with the edition that it names, and diagnose its noise."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from cobotwire import editions
from cobotwire.capture.packet import Direction, Interface
from cobotwire.capture.reader import CaptureReader
from cobotwire.capture.streams import DirectionStream, cut
from cobotwire.codec.interface import Codec, Frame, Listening
from cobotwire.diagnose import Diagnoser, Item
from cobotwire.inspect.recorded_edition import codec_of_recording
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.messages import Reply, Request


class CapturedMessage(NamedTuple):
    """A decoded frame of a capture.

    Attributes:
        time_ns: when its first byte was sent or received, in nanoseconds since 1970 (UTC).
        interface: an index into ``CaptureReader.interfaces``.
        direction: whether it was sent or received.
        message: the typed message, for ``match``; the error if a field holds a value that the
            edition does not allow.
    """

    time_ns: int
    interface: int
    direction: Direction
    message: Request[Any] | Reply[Any] | ProtocolError


def messages(capture: CaptureReader, edition: str = editions.DEFAULT) -> Iterator[CapturedMessage]:
    """Yield the decoded messages of a capture; ``edition`` applies if the capture names none.

    ::

        for captured in messages(read("arm.pcapng")):
            match captured.message:
                case SendAngle(joint, angle):
                    print("request", joint, angle)
                case GetAnglesReply(angles):
                    print("reply", angles)
    """
    events = cut(capture, lambda interface: codec_of_interface(capture, interface, edition))
    for stream, cut_events, _ in events:
        for event in cut_events:
            if isinstance(event, Frame):
                time_ns = stream.time_of(event.offset)
                yield CapturedMessage(time_ns, stream.interface, stream.direction, _typed(event))


def _typed(frame: Frame) -> Request[Any] | Reply[Any] | ProtocolError:
    try:
        return frame.message.typed
    except ProtocolError as error:
        return error


def diagnose_capture(
    capture: CaptureReader,
    edition: str,
    listening: Listening = "both",
    *,
    accept_unknown: bool = False,
) -> Iterator[tuple[DirectionStream, list[Item]]]:
    """Yield the frames and findings of a capture with their streams; see :func:`cut`.

    If a request was sent on an interface, a copy of it that was received there is an echo.
    """
    diagnosers: dict[DirectionStream, Diagnoser] = {}
    sent: dict[int, list[bytes]] = {}
    for stream, events, idle in cut(
        capture,
        lambda interface: codec_of_interface(capture, interface, edition),
        listening,
        accept_unknown=accept_unknown,
    ):
        if stream not in diagnosers:
            diagnosers[stream] = Diagnoser(stream.codec, stream.listening)
        diagnoser = diagnosers[stream]
        if stream.direction == "received":
            for data in sent.pop(stream.interface, ()):
                diagnoser.sent(data)
        items = diagnoser.feed(events) + (diagnoser.flush() if idle else [])
        if stream.direction == "sent":
            frames = [item.data for item in items if isinstance(item, Frame)]
            sent.setdefault(stream.interface, []).extend(frames)
        yield stream, items


def codec_of_interface(capture: CaptureReader, interface: int, default_edition: str) -> Codec:
    """Return the codec for an interface; see :func:`~.recorded_edition.codec_of_recording`."""
    return codec_of_recording(capture.interfaces[interface].edition, default_edition)


def recorded_codecs(default_edition: str = editions.DEFAULT) -> Callable[[Interface], Codec]:
    """Return a function from an interface to the codec of the edition that it names.

    ::

        columns = read_columns("arm.pcapng", recorded_codecs())

    If an interface names no edition, the codec is that of the default edition. The function raises
    UsageError if the edition is not installed.
    """
    return lambda interface: codec_of_recording(interface.edition, default_edition)
