"""The Rust codec behind the same interface. Importing this fails where no binary was built."""

from __future__ import annotations

from cobotwire._native import NativeCodec, NativeFrame
from cobotwire.codec.events import Frame

__all__ = ["NativeCodec"]

Frame.register(NativeFrame)
