"""Requests with wrong values: scale, sign, order, byte order, width, range, list, rounding."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.conformance.codec.questions.frames import frame_of
from cobotwire.conformance.samples.raw import beyond, with_one
from cobotwire.protocol.table import Field, Number, Variant
from mutation.client.sessions import ClientMutant, Session
from mutation.tables import wrong_tables


def wrong_values(session: Session) -> Iterator[ClientMutant]:
    """Yield a client for each way to send a number wrong, if the frame differs."""
    seen = {session.frame}
    for kind, text, frame in _frames(session):
        if frame not in seen:
            seen.add(frame)
            yield session.mutant(kind, text, frame + session.text)


def _frames(session: Session) -> Iterator[tuple[str, str, bytes]]:
    for index, field in enumerate(session.variant.fields):
        case = session.variant.raw_case(field, session.raw_values)
        assert case is not None, "an ordinary selector has a case"
        for element, number in enumerate(case.numbers):
            name = f"{field.name}.{number.name or element}" if field.many else field.name
            for kind, text, raw in _numbers(field, number, session.raw_values[index][element]):
                wrong = with_one(session.raw_values, index, element, raw)
                yield kind, f"{name} {text}", session.frame_with(wrong)
        yield from _rows(session, index, field)
    yield from _variants(session)


def _numbers(field: Field, number: Number, raw: int) -> Iterator[tuple[str, str, int]]:
    top = 256**number.width
    if not field.choices:
        yield "scale", "ten times as large", raw * 10
        yield "scale", "a tenth as large", raw // 10
        yield "scale", "a hundred times as large", raw * 100
        yield "sign", "with the other sign", -raw
        yield "rounding", "a step too far", raw + 1
        yield "rounding", "a step too short", raw - 1
    for wrong in beyond(field, number):
        yield "list" if field.choices else "range", f"as {wrong}", wrong
    if number.width > 1:
        word = (raw % top).to_bytes(number.width, "big")
        yield "endianness", "low byte first", int.from_bytes(word, "little")


def _rows(session: Session, index: int, field: Field) -> Iterator[tuple[str, str, bytes]]:
    row = session.raw_values[index]
    if len(row) < 2:
        return
    before, after = session.raw_values[:index], session.raw_values[index + 1 :]
    for text, turned in (
        ("last element first", row[::-1]),
        ("first two swapped", (row[1], row[0], *row[2:])),
    ):
        frame = session.frame_with((*before, turned, *after))
        yield "order", f"{field.name} {text}", frame


def _variants(session: Session) -> Iterator[tuple[str, str, bytes]]:
    """Yield the fields in another order or width, as if the spec had been misread."""
    for kind, text, variant in _misread(session):
        data = variant.pack(session.raw_values)
        yield kind, text, frame_of(session.table, session.command.id, data)
    if len(session.variant.fields) > 1:
        turned = Variant(session.variant.fields[::-1])
        if not any(field.selector >= 0 for field in turned.fields):
            data = turned.pack(session.raw_values[::-1])
            frame = frame_of(session.table, session.command.id, data)
            yield "order", "fields in the opposite order", frame


def _misread(session: Session) -> Iterator[tuple[str, str, Variant]]:
    one = session.table._replace(commands=(session.command,))
    for wrong in wrong_tables(one, ("request",)):
        if wrong.kind == "width" and wrong.place.variant == session.position:
            variant = wrong.table.commands[0].request[session.position]
            yield wrong.kind, wrong.text, variant
