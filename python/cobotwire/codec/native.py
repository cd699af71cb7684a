"""Load the Rust codec; importing this module fails if its binary is not installed."""

from __future__ import annotations

from typing import Literal

from cobotwire._native import NativeCaptureReader, NativeCodec, NativeFrame, NativeSummary
from cobotwire.codec.events import Frame
from cobotwire.codec.interface import Codec
from cobotwire.protocol.table import Table

__all__ = ["NativeCaptureReader", "NativeCodec", "NativeSummary", "native_codec"]

Frame.register(NativeFrame)


def native_codec(table: Table) -> Codec:
    """Return the native codec of a table."""
    return NativeCodec(table) if table.frame.reply_has_id else _ReplyWithoutId(table)


class _ReplyWithoutId:
    """The native codec, except that the reference makes the columns.

    The native columns are grouped by LEN and id, but these replies carry no id.
    """

    name: Literal["native"] = "native"

    def __init__(self, table: Table) -> None:
        from cobotwire.codec.reference import ReferenceCodec

        native, reference = NativeCodec(table), ReferenceCodec(table)
        self.table = table
        self.encode, self.decode = native.encode, native.decode
        self.framer, self.scan = native.framer, native.scan
        self.decode_columns, self.column_reader = reference.decode_columns, reference.column_reader
