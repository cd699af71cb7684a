"""Load the Rust codec; importing this module fails if its binary is not installed."""

from __future__ import annotations

from cobotwire._native import NativeCodec, NativeFrame
from cobotwire.codec.events import Frame

__all__ = ["NativeCodec"]

Frame.register(NativeFrame)
