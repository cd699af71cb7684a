"""Recordings of a line in pcapng files, which Wireshark reads; see ``docs/captures.md``."""

from cobotwire.capture.file import Recording
from cobotwire.capture.packet import Direction, Interface, Kind, Packet, Piece
from cobotwire.capture.reader import CaptureReader, is_capture, read
from cobotwire.capture.recorder import Recorder
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
