"""Record serial traffic to pcapng files, which Wireshark reads, and read it back.

See ``docs/captures.md``.
"""

from cobotwire.capture.packet import Direction, Interface, Kind, Packet, Piece
from cobotwire.capture.reader import CaptureReader, is_capture, read
from cobotwire.capture.recorder import Recorder
from cobotwire.capture.recording import Recording
from cobotwire.capture.writer import CaptureWriter

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
