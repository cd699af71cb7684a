"""The links that carry the bytes. They know errors, and nothing of the protocol."""

from cobotwire.transport.interface import Transport

__all__ = ["Transport"]
