"""Formats parts of the model for findings."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from cobotwire_codegen.model import (
    Address,
    Command,
    Effect,
    Firmware,
    Frame,
    Member,
    Quantity,
    State,
    Text,
    Variant,
    Wire,
)
from cobotwire_codegen.render.words import decimal, lines

LONGEST = 60

__all__ = [
    "address_range",
    "choices",
    "effect",
    "firmware",
    "frame_check",
    "in_quotes",
    "layout",
    "lines",
    "member",
    "names",
    "samples",
    "short",
    "sign",
    "span",
    "state",
    "template",
    "variant",
    "yes",
]


def short(text: str) -> str:
    """Return a text, cut if it is longer than ``LONGEST``; the spec has the full text."""
    return text if len(text) <= LONGEST else text[: LONGEST - 3].rstrip() + "..."


def in_quotes(text: str) -> str:
    """Return a text in quotes, cut if it is long; an empty text stays empty."""
    return f'"{short(text)}"' if text else ""


def firmware(stated: Firmware | None) -> str:
    """Return the firmware versions that a command needs, and the sources that state them."""
    versions = stated.versions.items() if stated else ()
    sources = stated.evidence if stated else ()
    parts = [f"{name} {decimal(version)}" for name, version in versions]
    return short(", ".join([*parts, *(f"{s.source}: {s.says}" for s in sources)])) or "none"


def frame_check(frame: Frame) -> str:
    """Return the check of a frame format."""
    check = frame.check
    if check is None:
        return "footer"
    crc = f" {tuple(check.crc)}" if check.crc else ""
    covered = f"{check.word}{crc} from {check.covers_from}"
    return f"{covered} ({count_of_bytes(check.width)}, {check.order})"


def count_of_bytes(count: int) -> str:
    """Return a number of bytes in words."""
    return f"{count} byte{'' if count == 1 else 's'}"


def layout(frame: Frame) -> str:
    """Return the fixed parts of a frame format, and what LEN counts."""
    numbers = {"length": frame.length_number, "command": frame.command_number}
    parts = [
        f"{part} ({count_of_bytes(numbers[part].width)}, {numbers[part].order})"
        if part in numbers
        else part
        for part in frame.layout
    ]
    replies = "" if frame.replies_have_command else "; replies have no command"
    # Other rules report whether a frame ends with a check or a footer, so both look alike here.
    end = "check or footer"
    counted = {{"check": end, "footer": end}.get(part, part) for part in frame.counted}
    return f"{', '.join(parts)}; LEN counts {', '.join(sorted(counted))}{replies}"


def address_range(frame: Frame) -> str:
    """Return the address range of a frame format."""
    found = frame.address_range
    return f"{found[0]}..{found[-1]}" if found else "none"


def yes(value: bool) -> str:
    """Return a truth value as a word."""
    return "yes" if value else "no"


def names(found: Iterable[str]) -> str:
    """Return a list of names as text."""
    return ", ".join(found)


def hexed(data: bytes) -> str:
    """Return bytes as the spec writes them."""
    return data.hex(" ").upper()


def span(ends: tuple[Fraction, Fraction]) -> str:
    """Return a range as text."""
    return f"{decimal(ends[0])}..{decimal(ends[1])}"


def in_unit(quantity: Quantity) -> tuple[Fraction, Fraction]:
    """Return the effective range in the quantity's unit."""
    return quantity.ends


def choices(quantity: Quantity) -> str:
    """Return the closed list of raw values."""
    return names(map(str, quantity.choices)) or "any in range"


def sign(wire: Wire) -> str:
    """Return the range that follows from the sign rule."""
    return f"{wire.minimum}..{wire.maximum}"


def member(found: Member | Address) -> str:
    """Return a member with its raw value."""
    return f"{found.name} = {found.value}"


def truth(found: Member) -> str:
    """Return whether a member is true in a condition."""
    return "true" if found.value and not found.falsy else "false"


def variant(found: Variant) -> str:
    """Return the fields of a variant."""
    return names(
        field.name if field.const is None else f"{field.name} = {field.const}" for field in found
    )


def effect(found: Effect | None) -> str:
    """Return what a command does, as the spec states it, in one line."""
    if found is None:
        return "not stated"
    values = names(f"{name}: {value}" for name, value in found.values)
    subjects = [*filter(None, (found.what, values and f"{{{values}}}"))]
    pairs = [f"{found.verb}: {' '.join(subjects)}"]
    pairs += [f"{name}: {value}" for name, value in found.options]
    pairs += [f"{name}: {effect(inner)}" for name, inner in found.cases]
    pairs += [f"at: {names(found.at)}"] if found.at else []
    pairs += [f"assumed: {found.assumed}"] if found.assumed else []
    return f"{{{names(pairs)}}}"


def state(found: State) -> str:
    """Return the declaration of a state, in one line."""
    parts = [found.type.name if found.type else "a text"]
    parts += [f"for each {names(found.each)}"] if found.each else []
    parts += [f"start {found.start}"] if found.start is not None else []
    return names(parts)


def samples(command: Command) -> str:
    """Return the numbers that a conformance run may send."""
    entries = (
        names(f"{name} {list(numbers)}" for name, numbers in entry) for entry in command.samples
    )
    return "; ".join(entries) or "any legal number"


def template(text: Text | None) -> str:
    """Return a text with its placeholders, in backquotes; empty without a text."""
    if text is None:
        return ""
    gaps = (f"{prefix}{{{name}}}" for prefix, (name, _) in zip(text.prefixes, text.fields))
    return f"`{''.join(gaps)}{text.suffix}`"
