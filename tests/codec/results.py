"""Everything that columns or scans hold, as plain values that tests compare."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from cobotwire.codec.interface import Columns, Scan


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
