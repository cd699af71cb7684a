"""Transports carry bytes: serial ports, TCP, and whatever else pyserial opens."""

from cobotwire.transport.interface import OpenedTransport, Transport
from cobotwire.transport.opening import open_transport
from cobotwire.transport.tapped import TappedTransport

__all__ = ["OpenedTransport", "TappedTransport", "Transport", "open_transport"]
