"""Requests with wrong values: scale, sign, order, byte order, width, range, list, rounding."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.conformance.codec.trials.frames import frame_of
from cobotwire.conformance.codec.trials.pictures import beyond, case_of, wire_data, with_one
from cobotwire.table import Field, Layout, Number
from mutation.client.mutant import ClientMutant
from mutation.client.sessions import Session
from mutation.tables import wrong_tables


def wrong_values(session: Session) -> Iterator[ClientMutant]:
    """Every number of the request, wrong in every way that shows in its bytes."""
    seen = {session.frame}
    for kind, text, frame in _frames(session):
        if frame not in seen:
            seen.add(frame)
            name = f"{kind}: {session.place}: {text}"
            writes = session.writes(frame + session.behind)
            yield ClientMutant(kind, name, session.told(), writes)


def _frames(session: Session) -> Iterator[tuple[str, str, bytes]]:
    for index, field in enumerate(session.layout.fields):
        case = case_of(session.layout, field, session.wholes)
        assert case is not None, "an ordinary selector has a case"
        for element, number in enumerate(case.numbers):
            name = f"{field.name}.{number.name or element}" if field.many else field.name
            for kind, text, whole in _numbers(field, number, session.wholes[index][element]):
                wrong = with_one(session.wholes, index, element, whole)
                yield kind, f"{name} {text}", session.frame_with(wrong)
        yield from _rows(session, index, field)
    yield from _layouts(session)


def _numbers(field: Field, number: Number, whole: int) -> Iterator[tuple[str, str, int]]:
    top = 256**number.width
    if not field.choices:
        yield "scale", "ten times as large", whole * 10
        yield "scale", "a tenth as large", whole // 10
        yield "scale", "a hundred times as large", whole * 100
        yield "sign", "with the other sign", -whole
        yield "rounding", "a step too far", whole + 1
        yield "rounding", "a step too short", whole - 1
    for wrong in beyond(field, number):
        yield "list" if field.choices else "range", f"as {wrong}", wrong
    if number.width > 1:
        word = (whole % top).to_bytes(number.width, "big")
        yield "endianness", "low byte first", int.from_bytes(word, "little")


def _rows(session: Session, index: int, field: Field) -> Iterator[tuple[str, str, bytes]]:
    row = session.wholes[index]
    if len(row) < 2:
        return
    before, behind = session.wholes[:index], session.wholes[index + 1 :]
    for text, turned in (
        ("last element first", row[::-1]),
        ("first two changed over", (row[1], row[0], *row[2:])),
    ):
        frame = session.frame_with((*before, turned, *behind))
        yield "order", f"{field.name} {text}", frame


def _layouts(session: Session) -> Iterator[tuple[str, str, bytes]]:
    """Fields in another order or width, as somebody builds them who has misread the spec."""
    for kind, text, layout in _misread(session):
        data = wire_data(layout, session.wholes)
        yield kind, text, frame_of(session.table, session.command.id, data)
    if len(session.layout.fields) > 1:
        turned = Layout(session.layout.fields[::-1])
        if not any(field.selector >= 0 for field in turned.fields):
            data = wire_data(turned, session.wholes[::-1])
            frame = frame_of(session.table, session.command.id, data)
            yield "order", "fields in the opposite order", frame


def _misread(session: Session) -> Iterator[tuple[str, str, Layout]]:
    one = session.table.__class__(
        session.table.edition,
        session.table.title,
        session.table.joints,
        session.table.baudrate,
        session.table.frame,
        (session.command,),
    )
    for wrong in wrong_tables(one, ("request",)):
        if wrong.kind == "width" and wrong.place.form == session.form:
            layout = wrong.table.commands[0].request[session.form]
            yield wrong.kind, wrong.text, layout
