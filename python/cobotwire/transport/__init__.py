"""Transports carry bytes: serial ports, TCP, and whatever else pyserial opens."""

import logging

from cobotwire.transport.interface import OpenedTransport, Transport
from cobotwire.transport.opening import open_transport
from cobotwire.transport.tapped import TappedTransport

__all__ = ["OpenedTransport", "TappedTransport", "Transport", "open_transport"]

# Without a handler of its own a library's warnings go to stderr.
logging.getLogger("cobotwire").addHandler(logging.NullHandler())
