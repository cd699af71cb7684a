"""Chooses the codec: the Rust one where its binary is there, else the Python reference.

``COBOTWIRE_CODEC=reference`` or ``=native`` in the environment forces one.
"""

from __future__ import annotations

import os
from functools import lru_cache
from typing import Literal

from cobotwire.codec.interface import Codec
from cobotwire.errors import UsageError
from cobotwire.table import Table

VARIABLE = "COBOTWIRE_CODEC"
CodecName = Literal["reference", "native"]


def chosen() -> CodecName:
    """The name of the codec in use.

    Raises:
        UsageError: ``COBOTWIRE_CODEC`` names no codec, or forces the native one in vain.
    """
    forced = os.environ.get(VARIABLE, "")
    if forced not in ("", "reference", "native"):
        raise UsageError(VARIABLE, forced, "reference or native, or unset")
    if forced == "reference":
        return "reference"
    if native_available():
        return "native"
    if forced == "native":
        raise UsageError(VARIABLE, forced, "reference: this installation has no binary")
    return "reference"


@lru_cache(maxsize=1)
def native_available() -> bool:
    """Whether the Rust codec's binary can be loaded here."""
    try:
        import cobotwire.codec.native  # noqa: F401  (asking whether it loads is the point)
    except ImportError:
        return False
    return True


def load(table: Table, name: CodecName | None = None) -> Codec:
    """A codec for an edition: the one named, else the one in use.

    Raises:
        UsageError: there is no codec of that name, or the native one has no binary here.
    """
    if name is None:
        name = chosen()
    elif name not in ("reference", "native"):
        raise UsageError("codec", name, "native or reference, or None")
    elif name == "native" and not native_available():
        raise UsageError("codec", name, "reference: this installation has no binary")
    if name == "reference":
        from cobotwire.codec.reference import ReferenceCodec

        return ReferenceCodec(table)
    from cobotwire.codec.native import NativeCodec

    return NativeCodec(table)
