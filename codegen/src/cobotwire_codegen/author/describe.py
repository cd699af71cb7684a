"""Describes a problem code or a command as plain text for a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from textwrap import fill, indent

from cobotwire_codegen import lower
from cobotwire_codegen.author.codes import Explanation
from cobotwire_codegen.language import schema
from cobotwire_codegen.language.edition import FILES
from cobotwire_codegen.language.records import Choice
from cobotwire_codegen.model import Command, Edition, Evidence, Field, Quantity, Variant, Vector
from cobotwire_codegen.model.frame import Direction
from cobotwire_codegen.render import markdown, words
from cobotwire_codegen.render.byte_table import byte_rows
from cobotwire_codegen.wire import encode_variant

_WIDTH = 96


def describe_code(explanation: Explanation) -> str:
    """Return the explanation of a problem code."""
    parts = [
        f"{explanation.code}: {explanation.means}",
        f"Why: {explanation.why}",
        f"Fix: {explanation.fix}",
    ]
    text = "\n".join(fill(part, _WIDTH, subsequent_indent="  ") for part in parts)
    wrong, right = indent(explanation.wrong, "  "), indent(explanation.right, "  ")
    return f"{text}\n\nWrong:\n{wrong}\n\nRight:\n{right}"


def describe_keys() -> dict[str, str]:
    """Return the meanings of each key of the language, one for each record that has it."""
    found: dict[str, list[str]] = {}
    for record in schema.records(FILES.values()):
        if not isinstance(record, Choice):
            for name, key in record.keys().items():
                line = f"{name} of {record.heading().lower()}: {key.doc}"
                found.setdefault(name, []).append(fill(line, _WIDTH, subsequent_indent="  "))
    return {name: "\n".join(lines) for name, lines in found.items()}


def describe_command(edition: Edition, command: Command) -> str:
    """Return the reference of a command."""
    return "\n".join(line.rstrip() for line in _command(edition, command))


def describe_vector(edition: Edition, vector: Vector) -> str:
    """Return a vector's frame byte by byte, with raw and physical values."""
    head = f"{vector.name}: {vector.direction} of {vector.command}"
    if vector.frame is None:
        return head
    lines = [head, markdown.hexed(vector.frame), ""]
    if vector.derived is not None:
        origin = vector.derived
        lines[2:] = [f"derived from {markdown.hexed(origin.frame)} of {origin.edition}", ""]
    command = next(each for each in edition.commands if each.name == vector.command)
    values = dict(vector.values)
    variant, data = encode_variant(command, vector.direction, values)
    start = len(vector.frame) - edition.frame.check_size - len(data)
    for field in variant:
        size = field.type.size
        raw = vector.frame[start : start + size]
        lines.append(f"{start:>3}  {markdown.hexed(raw):<18} {_decoded(field, values, raw)}")
        start += size
    return "\n".join(lines)


def _decoded(field: Field, values: dict[str, object], data: bytes) -> str:
    """Return a field's raw and physical values."""
    picked = str(values.get(field.selector))
    type = next((type for member, type in field.cases if member.name == picked), field.type)
    shown = []
    for name, part in type.parts:
        word, data = data[: part.size], data[part.size :]
        raw = part.wire.raw_of(word)
        unit = f" {words.units(part.unit)}" if isinstance(part, Quantity) and part.unit else ""
        value = part.read(word)
        physical = words.decimal(value) if isinstance(value, Fraction) else value
        shown.append(f"{name or field.name} = {physical}{unit} (raw {raw})")
    return ", ".join(shown)


def _command(edition: Edition, command: Command) -> Iterator[str]:
    source = f", document {words.lines(command.source)}" if command.source else ""
    yield f"{command.name}: {command.title} (id {command.id:#04x}, {command.safety}{source})"
    yield _paragraph(command.doc)
    for note in command.notes:
        yield _paragraph(f"Note: {note}")
    if command.alias:
        yield _paragraph(f"The same message as {command.alias}, under a second name.")
    for variant in command.requests:
        yield from _message(edition, command, "request", variant)
    yield from _reply(edition, command)
    yield from _fields(command)
    yield from _vectors(edition, command)
    yield from _disputes(edition, command)
    yield from _history(edition, command)


def _paragraph(text: str) -> str:
    return fill(text, _WIDTH, initial_indent="  ", subsequent_indent="    ")


def _message(
    edition: Edition, command: Command, direction: Direction, variant: Variant
) -> Iterator[str]:
    yield ""
    yield f"{direction.capitalize()}, byte by byte:"
    for position, content, value in byte_rows(edition, command, direction, variant):
        yield f"  {position:<6} {content.replace('`', ''):<24} {value}"


def _reply(edition: Edition, command: Command) -> Iterator[str]:
    if command.request_text is not None:
        yield f"\nFollowed by text outside any frame: {markdown.pattern(command.request_text)}"
    for variant in command.replies:
        yield from _message(edition, command, "reply", variant)
    if command.ack:
        yield "  An acknowledgement: it may come, come late or never; clients do not wait for it."
    if command.text is not None:
        yield f"\nReply, text outside any frame: {markdown.pattern(command.text)}"
    if command.awaits_reply:
        yield f"  Deadline of the reply: {command.deadline_ms} ms."
    elif not command.replies:
        yield "\nReply: none."


def _fields(command: Command) -> Iterator[str]:
    rows = markdown.field_rows(command)
    if rows:
        yield "\nFields:"
    for direction, field in rows:
        doc = markdown.field_doc(field)
        yield _paragraph(f"{field.name} ({direction}): {doc} {words.allowed(field)}.")


def _vectors(edition: Edition, command: Command) -> Iterator[str]:
    found = [vector for vector in edition.vectors if vector.command == command.name]
    if found:
        yield "\nVectors:"
    yield from map(_vector, found)


def _vector(vector: Vector) -> str:
    shown = vector.text if vector.frame is None else markdown.hexed(vector.frame)
    values = f": {markdown.values_in_words(vector)}" if vector.values else ""
    line = f" (line {vector.line})" if vector.line else ""
    stray = "no frame of its own; see the errata"
    return f"  {vector.name}{line}, {vector.direction}: {shown or stray}{values}"


def _disputes(edition: Edition, command: Command) -> Iterator[str]:
    types = (q.disputed for q in markdown.disputed_types(edition, command))
    for dispute in (*command.disputed, *(dispute for some in types for dispute in some)):
        yield ""
        yield lower.dispute_note(dispute)
        yield from _evidence(dispute.evidence)


def _history(edition: Edition, command: Command) -> Iterator[str]:
    for change in command.changes:
        yield f"\nDiffers from {edition.base}: {change.what} {change.why}"
        yield from _evidence(change.evidence)
    for erratum in markdown.errata(edition, command):
        where = words.lines(erratum.lines)
        yield f"\nErratum ({where}): the document says {erratum.says!r}"
        yield _paragraph(f"read as: {erratum.read}")
        yield _paragraph(f"because {erratum.why}")


def _evidence(pieces: tuple[Evidence, ...]) -> Iterator[str]:
    for piece in pieces:
        where = f", {words.lines(piece.lines)}" if piece.lines else ""
        yield _paragraph(f"{piece.source}{where}: {piece.says}")
