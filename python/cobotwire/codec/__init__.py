"""Choose the codec: the Rust codec if its binary can be loaded, else the Python reference.

The binary is not loaded in a subinterpreter: its errors would have the classes of another
interpreter.

The environment variable ``COBOTWIRE_CODEC`` (``reference`` or ``native``) forces one.
"""

from __future__ import annotations

import os
from functools import lru_cache
from typing import TYPE_CHECKING, Literal

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.shared import once_per_table

if TYPE_CHECKING:
    from cobotwire.codec.interface import Codec
    from cobotwire.protocol.table import Table

VARIABLE = "COBOTWIRE_CODEC"
CodecName = Literal["reference", "native"]
NOT_INSTALLED = "the native codec is not installed"


def chosen() -> CodecName:
    """Return the name of the codec in use.

    Raises:
        UsageError: ``COBOTWIRE_CODEC`` names no codec, or its binary cannot be loaded.
    """
    forced = os.environ.get(VARIABLE, "")
    if forced not in ("", "reference", "native"):
        raise UsageError(VARIABLE, forced, "native, reference, or unset")
    if forced == "reference":
        return "reference"
    if native_available():
        return "native"
    if forced == "native":
        raise _no_binary(f"{VARIABLE}=native")
    return "reference"


def native_available() -> bool:
    """Return whether the Rust codec's binary can be loaded."""
    return not _obstacle()


@lru_cache(maxsize=1)
def _obstacle() -> str:
    """Return why the Rust codec's binary cannot be loaded; empty if it can."""
    try:
        import cobotwire._native  # noqa: F401  (imported only to see whether it loads)
    except ModuleNotFoundError:
        return NOT_INSTALLED
    except ImportError as error:
        return f"the native codec cannot be loaded ({error})"
    return ""


def load(table: Table, name: CodecName | None = None) -> Codec:
    """Return a codec for an edition: the named one, else the one in use.

    It has no state, so all clients of an edition share one.

    Raises:
        UsageError: there is no codec of that name, or its binary cannot be loaded.
    """
    if name is None:
        name = chosen()
    elif name not in ("reference", "native"):
        raise UsageError("codec", name, "native, reference or None")
    elif name == "native" and not native_available():
        raise _no_binary("codec='native'")
    return _reference(table) if name == "reference" else _native(table)


@once_per_table
def _reference(table: Table) -> Codec:
    from cobotwire.codec.reference import ReferenceCodec

    return ReferenceCodec(table)


@once_per_table
def _native(table: Table) -> Codec:
    from cobotwire.codec.native import native_codec

    return native_codec(table)


def _no_binary(what: str) -> UsageError:
    message = f"{what}: {_obstacle() or NOT_INSTALLED}; use 'reference'"
    return UsageError(what, "native", "reference", message=message)
