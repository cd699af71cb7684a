"""The links that carry the bytes. They know errors, and nothing of the protocol."""

from cobotwire.transport.interface import Link, Transport
from cobotwire.transport.opening import open_link
from cobotwire.transport.tapped import TappedLink

__all__ = ["Link", "TappedLink", "Transport", "open_link"]
