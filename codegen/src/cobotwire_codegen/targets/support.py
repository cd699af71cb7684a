"""Refuses editions with frames or types that an output target cannot express yet."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen import lower
from cobotwire_codegen.errors import Problem, SpecError
from cobotwire_codegen.model import Edition, Quantity, Type, Value
from cobotwire_codegen.model.shapes import Shaped


def require_plain(edition: Edition, target: str) -> None:
    """Raise an error unless frames are the usual ones, of integers, enums, flags and their values.

    Raises:
        SpecError: the frame format is another one, or a field has another type; the text names the
            command, the field and the type.
    """
    problems = [*_unusual_frames(edition, target), *_unsupported(edition, target)]
    if problems:
        raise SpecError(problems)


def _unusual_frames(edition: Edition, target: str) -> Iterator[Problem]:
    if not edition.frame.usual:
        message = (
            f"the {target} target cannot express the frames of {edition.name}: it needs a header "
            "of two bytes, LEN and CMD of one byte each, LEN over all bytes after itself, and a "
            "footer, crc16-modbus or sum"
        )
        yield Problem(edition.frame.place, "bad-frame", message)


def _unsupported(edition: Edition, target: str) -> Iterator[Problem]:
    for command in edition.commands:
        for field in command.fields:
            for _, type in lower.cases(field):
                kind = _other_kind(type)
                if kind:
                    message = (
                        f"the {target} target cannot express {field.name} of {command.name}: "
                        f"{type.name} is {kind}"
                    )
                    yield Problem(field.place, "unsupported-type", message)


def _other_kind(type: Type) -> str:
    if isinstance(type, Shaped):
        return {"bits": "bits", "bytes": "bytes"}.get(type.kind, f"a {type.kind}")
    parts = [item for _, item in type.items] if isinstance(type, Value) else [type]
    if any(isinstance(part, Quantity) and part.wire.is_float for part in parts):
        return "a float"
    return ""
