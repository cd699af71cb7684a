"""Convert columns and scans to plain values, which tests compare."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from cobotwire.codec.interface import Codec, Columns, Frame, Listening, Scan
from cobotwire.protocol.errors import ProtocolError


def everything(found: Scan | Columns) -> Any:
    """Return all that was found, in its order; columns as bytes, since NaN equals nothing."""
    noise = bytes(found.noise.offset), bytes(found.noise.size)
    if isinstance(found, Scan):
        return bytes(found.offset), noise, found.counters
    rows = [
        (
            each.command.name,
            each.direction,
            each.variant_index,
            bytes(each.offset),
            None if each.address is None else (each.address.format, bytes(each.address)),
            [(each[name].format, each[name].shape, bytes(each[name])) for name in each.names],
        )
        for each in found
    ]
    return rows, bytes(found.rejected), noise, found.counters


def joined_columns(parts: Sequence[Columns]) -> Any:
    """Return rows, rejected frames and noise of consecutive columns as if they were one.

    Values are text, because NaN does not equal itself.
    """
    rows: dict[Any, list[str]] = {}
    rejected: list[int] = []
    noise: list[tuple[int, int]] = []
    for part in parts:
        for each in part:
            columns = [each[name].tolist() for name in each.names]
            columns += [] if each.address is None else [each.address.tolist()]
            key = each.command.name, each.direction, each.variant_index
            rows.setdefault(key, []).extend(map(repr, zip(each.offset.tolist(), *columns)))
        rejected += part.rejected.tolist()
        for at, size in zip(part.noise.offset.tolist(), part.noise.size.tolist()):
            if noise and sum(noise[-1]) == at:
                noise[-1] = noise[-1][0], noise[-1][1] + size
            else:
                noise.append((at, size))
    return rows, rejected, noise


def check_against_framer(codec: Codec, listening: Listening, stream: bytes) -> None:
    """Check that columns and a scan hold the decoded frames and the noise of a framer."""
    framer = codec.framer(listening)
    events = framer.feed(stream) + framer.flush()
    rows: dict[Any, list[Any]] = {}
    rejected: list[int] = []
    noise: list[tuple[int, int]] = []
    for event in events:
        if not isinstance(event, Frame):
            if noise and sum(noise[-1]) == event.offset:
                noise[-1] = noise[-1][0], noise[-1][1] + len(event.data)
            else:
                noise.append((event.offset, len(event.data)))
            continue
        try:
            message = event.message
        except ProtocolError:
            rejected.append(event.offset)
        else:
            key = message.command.name, message.direction
            values = [list(v) if isinstance(v, tuple) else v for v in message.values]
            rows.setdefault(key, []).append((event.offset, message.address, values))
    columns = codec.decode_columns(stream, listening)
    found: dict[Any, list[Any]] = {}
    for each in columns:
        offsets, fields = each.offset.tolist(), [each[name].tolist() for name in each.names]
        addresses = [None] * len(offsets) if each.address is None else each.address.tolist()
        values_of_rows = [list(row) for row in zip(*fields)] or [[] for _ in offsets]
        key = each.command.name, each.direction
        found.setdefault(key, []).extend(zip(offsets, addresses, values_of_rows))
    assert {key: sorted(of_key) for key, of_key in found.items()} == rows
    assert columns.rejected.tolist() == rejected
    scan = codec.scan(stream, listening)
    assert scan.offset.tolist() == [event.offset for event in events if isinstance(event, Frame)]
    for bulk in (columns, scan):
        assert list(zip(bulk.noise.offset.tolist(), bulk.noise.size.tolist())) == noise
        assert bulk.counters == framer.counters
