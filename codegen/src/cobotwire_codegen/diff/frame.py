"""Compares the frame formats and the transports."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen.diff import prose, words
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.match import match
from cobotwire_codegen.model import Address, Frame


def frame_changes(old: Frame, new: Frame) -> Iterator[Finding]:
    """Compare everything about the frame and the transport."""
    numbers = ("maximum-data", old.maximum_data, new.maximum_data)
    rates = ("baudrate", old.baudrate, new.baudrate)
    deadlines = ("deadline", old.deadline_ms, new.deadline_ms)
    checks = ("check", words.frame_check(old), words.frame_check(new))
    footers = ("footer", words.hexed(old.footer), words.hexed(new.footer))
    headers = ("header", words.hexed(old.header), words.hexed(new.header))
    layouts = ("layout", words.layout(old), words.layout(new))
    for what, before, after in (headers, layouts, checks, footers, numbers, rates, deadlines):
        if before != after:
            yield finding(f"{what}-changed", "frame", before, after)
    yield from _addresses(old.addresses, new.addresses)
    ranges = [words.address_range(side) for side in (old, new)]
    if ranges[0] != ranges[1]:
        yield finding("addresses-changed", "frame/address_range", *ranges)
    yield from prose.doc("frame", old.doc, new.doc)


def _addresses(old: tuple[Address, ...], new: tuple[Address, ...]) -> Iterator[Finding]:
    where = "frame/addresses"
    matched = match(old, new, lambda member: member.value)
    # Without addresses, frames have no address byte. With addresses, clients use the first one by
    # default, so a change in their order matters.
    moved = [j for _, j in matched.places] != list(range(len(matched.places)))
    if matched.removed or moved or (new and not old):
        shown = [words.names(map(words.member, side)) or "none" for side in (old, new)]
        yield finding("addresses-changed", where, *shown)
        return
    for member in matched.added:
        yield finding("address-added", f"{where}/{member.name}", "", words.member(member))
    for before, after in matched.pairs:
        if before.replies != after.replies:
            where_now = f"{where}/{after.name}"
            yield finding("address-replies-changed", where_now, before.replies, after.replies)
        if before.joints != after.joints:
            where_now = f"{where}/{after.name}"
            shown = [str(side.joints or "those of the edition") for side in (before, after)]
            yield finding("address-joints-changed", where_now, *shown)
        if before.name != after.name:
            yield finding("address-renamed", f"{where}/{after.name}", before.name, after.name)
        yield from prose.doc(f"{where}/{after.name}", before.doc, after.doc)
