"""Make small tables with features that no edition has: odd widths, signs, scales and ids."""

from __future__ import annotations

from cobotwire.protocol.table import Case, Command, Field, FrameFormat, Number, Table, Variant

FOOTER = FrameFormat(b"\xfe\xfe", b"\xfa", 60)


def number(
    width: int = 1,
    low: int = 0,
    high: int | None = None,
    *,
    signed_at: int | None = None,
    scale: tuple[int, int] = (1, 1),
) -> Number:
    """Return a big-endian number with these bounds; it is signed if ``low`` is negative."""
    top = 256**width - 1
    if signed_at is None:
        signed_at = top // 2 if low < 0 else top
    return Number("", width, "big", signed_at, *scale, low, signed_at if high is None else high, "")


def field(name: str, *numbers: Number, many: bool = False, choices: tuple[int, ...] = ()) -> Field:
    """Return a field with one case."""
    return Field(name, "number", (Case((), numbers),), "", many=many, choices=choices)


def command(
    id: int,
    name: str,
    request: tuple[Variant, ...] = (Variant(()),),
    reply: tuple[Variant, ...] = (),
) -> Command:
    """Return a query with these variants of its request and its reply."""
    return Command(id, name, "", "", "test", "query", 100, request, reply)


def table(*commands: Command, frame: FrameFormat = FOOTER) -> Table:
    """Return an edition with these commands."""
    return Table("small", "A small table", 6, 115200, frame, commands)
