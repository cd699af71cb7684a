"""Record serial traffic to pcapng files, which Wireshark reads, and read it back.

See ``docs/captures.md``.
"""

from typing import TYPE_CHECKING

__all__ = [
    "CaptureReader",
    "CaptureWriter",
    "Direction",
    "Interface",
    "Kind",
    "Packet",
    "Piece",
    "Recorder",
    "Recording",
    "is_capture",
    "read",
]

if TYPE_CHECKING:
    from cobotwire.capture.packet import Direction, Interface, Kind, Packet, Piece
    from cobotwire.capture.reader import CaptureReader, is_capture, read
    from cobotwire.capture.recorder import Recorder
    from cobotwire.capture.recording import Recording
    from cobotwire.capture.writer import CaptureWriter
else:
    # Imported when they are first used: reading bytes needs none of them.
    from cobotwire.protocol.lazy import lazy_names

    __getattr__, __dir__ = lazy_names(
        __name__,
        {
            ".packet": ["Direction", "Interface", "Kind", "Packet", "Piece"],
            ".reader": ["CaptureReader", "is_capture", "read"],
            ".recorder": ["Recorder"],
            ".recording": ["Recording"],
            ".writer": ["CaptureWriter"],
        },
        (),
    )
