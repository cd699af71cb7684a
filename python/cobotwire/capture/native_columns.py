"""Read captures into columns with the native reader."""

from __future__ import annotations

from collections.abc import Callable

from cobotwire.capture.captured_columns import CapturedColumns, StreamColumns
from cobotwire.capture.captured_rows import DIRECTIONS
from cobotwire.capture.damage import damaged
from cobotwire.capture.packet import Interface
from cobotwire.capture.packet_parsing import decoded, interface_of
from cobotwire.codec.interface import Codec, Data, Listening
from cobotwire.codec.native import NativeCaptureReader, NativeCodec, native_codec
from cobotwire.protocol.errors import UsageError


class NativeColumnsReader:
    """Reads a capture piece by piece; see :class:`cobotwire.capture.columns.ColumnsReader`."""

    def __init__(
        self, codec_of: Callable[[Interface], Codec], listening: Listening, raw: bool, name: str
    ) -> None:
        self._codec_of = codec_of
        self._name = name
        self._reader = NativeCaptureReader(self._codec, listening, raw)

    def add(self, data: Data) -> None:
        """Take the next bytes of the file."""
        self._reader.add(data)

    def feed(self, data: Data) -> CapturedColumns:
        """Take the next bytes of the file; return what later bytes cannot change."""
        self._reader.add(data)
        return self._taken()

    def finish(self) -> CapturedColumns:
        """Take the end of the file; return the rest."""
        self._reader.end()
        return self._taken()

    def _codec(self, name: bytes, description: bytes, speed: int) -> NativeCodec:
        interface = interface_of(name, description, speed)
        codec = self._codec_of(interface)
        if isinstance(codec, NativeCodec):
            return codec
        # Both codecs return the same values, so the native one may replace the reference.
        native = native_codec(codec.table)
        if isinstance(native, NativeCodec):
            return native
        message = (
            f"the replies of {codec.table.edition} carry no id, so their columns need one codec "
            "for all interfaces: pass a codec instead of a function"
        )
        raise UsageError("codec", codec.table.edition, message=message)

    def _taken(self) -> CapturedColumns:
        streams = []
        for interface, direction, columns, times, rejected, noise in self._reader.streams():
            views = [memoryview(each) for each in (*times, rejected, noise)]
            where = interface, DIRECTIONS[direction]
            streams.append(StreamColumns(*where, columns, views[:-2], *views[-2:]))
        application, size, finished, truncated_at, damage = self._reader.status
        error = None
        if damage is not None:
            offset, kind, numbers = damage
            error = damaged(self._name, offset, kind, *numbers)
        return CapturedColumns(
            self._name,
            decoded(application),
            tuple(interface_of(*each) for each in self._reader.interfaces),
            streams,
            size,
            finished,
            truncated_at,
            error,
        )
