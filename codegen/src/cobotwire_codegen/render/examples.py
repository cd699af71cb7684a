"""Chooses the example frames that the reference of a command shows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from cobotwire_codegen.model import Command, Edition, Vector
from cobotwire_codegen.render.diagram import Row, width
from cobotwire_codegen.render.words import lines

Direction = Literal["request", "reply"]


def examples(edition: Edition, command: Command) -> dict[Direction, Vector]:
    """Return the request and the reply that a page shows; the reply repeats the request's values.

    The document's own frames come first, and derived vectors come last.
    """
    every = [v for v in edition.vectors if v.command == command.name and v.frame]
    every.sort(key=_rank)
    requests = [vector for vector in every if vector.direction == "request"]
    replies = [vector for vector in every if vector.direction == "reply"]
    pairs = [(a, b) for a in requests for b in replies if _agree(edition, command, a, b)]
    if pairs:
        request, reply = min(pairs, key=lambda pair: (_rank(pair[0]), _rank(pair[1])))
        return {"request": request, "reply": reply}
    found: dict[Direction, Vector] = {"request": requests[0]} if requests else {}
    return found | ({"reply": replies[0]} if replies else {})


def _rank(vector: Vector) -> tuple[bool, bool]:
    return vector.derived is not None, not vector.example


def _agree(edition: Edition, command: Command, request: Vector, reply: Vector) -> bool:
    if edition.frame.address_values and request.frame and reply.frame:
        at = edition.frame.offset("address")
        if request.frame[at] != reply.frame[at]:
            return False
    sent, received = dict(request.values), dict(reply.values)
    echoed = {field.name for variant in command.replies for field in variant if field.echo}
    return all(sent[name] == received[name] for name in echoed & sent.keys() & received.keys())


def example_frame(edition: Edition, command: Command, direction: Direction, sizes: range) -> bytes:
    """Return the frame of an example with one of these sizes; empty without one.

    The example of :func:`examples` is preferred.
    """
    chosen = examples(edition, command).get(direction)
    every = [v for v in edition.vectors if v.command == command.name and v.direction == direction]
    fitting = [
        v.frame for v in [*([chosen] if chosen else []), *sorted(every, key=_rank)] if v.frame
    ]
    return next((frame for frame in fitting if len(frame) in sizes), b"")


def source_lines(edition: Edition, command: Command) -> str:
    """Return which lines of the document state a command and its examples; empty if none do."""
    stated = f"document, {lines(command.source)}" if command.source else ""
    found = sorted({v.line for v in examples(edition, command).values() if v.line})
    one = "an example" if len(found) == 1 else "examples"
    shown = f"{one} in {lines(tuple((line, line) for line in found))}" if found else ""
    return "; ".join(filter(None, (stated, shown)))


def derived(edition: Edition, command: Command) -> list[Vector]:
    """Return the examples of a page that were derived from those of the base."""
    return [vector for vector in examples(edition, command).values() if vector.derived]


def sizes_of(rows: Sequence[Row]) -> range:
    """Return how many bytes a message with these rows may have."""
    widths = [width(position) for position, _, _ in rows]
    least = sum(filter(None, widths))
    return range(least, 1 << 16) if None in widths else range(least, least + 1)
