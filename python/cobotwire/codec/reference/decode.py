"""Decode frames to values; reject illegal frames, and values that the edition does not allow."""

from __future__ import annotations

from cobotwire.codec.events import DecodedMessage, NoiseReason
from cobotwire.codec.reference.validator import Validator
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.frame_format import FrameFormat
from cobotwire.protocol.frame_index import MessageVariant
from cobotwire.protocol.rejection import FrameFault, reject_frame, reject_raw
from cobotwire.protocol.table import Case, Command, Field


def decode(validator: Validator, data: bytes, of: Command | None = None) -> DecodedMessage:
    """Decode exactly one frame; see :meth:`cobotwire.codec.interface.Codec.decode`."""
    data = bytes(data)
    verdict = _misnamed(validator, data, of) or validator.validate(data)
    if isinstance(verdict, str):
        raise _rejection(validator, verdict, data)
    if verdict < len(data):
        index = validator.indexes[0]
        raise reject_frame(index.table, index.direction, "trailing", verdict, data)
    return read(validator, data, of)


def read(validator: Validator, data: bytes, of: Command | None = None) -> DecodedMessage:
    """Decode a frame that is known to be legal, as the first message that allows its values."""
    heading = validator.heading_of(data)
    rejection: ProtocolError | None = None
    for message in validator.messages(heading, of):
        try:
            start = validator.frame.data_start(message.direction)
            values = _values(start, message, data)
        except ProtocolError as error:
            rejection = rejection or error
            continue
        address = validator.frame.address(data)
        return DecodedMessage(message.command, message.direction, message.variant, values, address)
    raise rejection or _rejection(validator, _why_no_message(validator, data, of), data)


def _misnamed(validator: Validator, data: bytes, of: Command | None) -> NoiseReason | None:
    if of is None:
        return None
    heading = validator.heading(data)
    return None if isinstance(heading, str) else validator.misnamed(heading, of)


def _why_no_message(validator: Validator, data: bytes, of: Command | None) -> NoiseReason:
    heading = validator.heading(data)
    if isinstance(heading, str):
        return heading
    return validator.misnamed(heading, of) or validator.reject(heading) or "unknown-id"


def _rejection(validator: Validator, reason: NoiseReason, data: bytes) -> ProtocolError:
    frame, index = validator.frame, validator.indexes[0]
    at = _rejected_at(frame, reason, data)
    return reject_frame(index.table, index.direction, reason, at, data)


def _rejected_at(frame: FrameFormat, reason: FrameFault, data: bytes) -> int:
    """Return the offset of the byte that rejects a frame at the start of ``data``."""
    if reason == "no-header":
        return next(i for i, byte in enumerate(frame.header) if data[i] != byte)
    if reason == "bad-check":
        return frame.overhead + frame.read_length(data) - frame.check_size
    places = {
        "bad-address": frame.address_at,
        "bad-length": frame.length_at,
        "unknown-id": frame.id_at,
    }
    at = places.get(reason)
    return len(data) if at is None else at


def _values(start: int, message: MessageVariant, data: bytes) -> tuple[object, ...]:
    values: list[object] = []
    offset = start
    for field in message.variant.fields:
        if field.kind == "bytes":  # all are legal
            values.append(data[offset : offset + field.size])
            offset += field.size
            continue
        case = _case(start, message, field, data)
        parts = _numbers(message, field, case, offset, data)
        bad = field.bad_text_at(parts)
        if bad is not None:
            at = offset + bad
            raise reject_raw(message.command, field, case, bad, data[at], at, data)
        values.append(field.present(parts))
        offset += field.size
    return tuple(values)


def _case(start: int, message: MessageVariant, field: Field, data: bytes) -> Case:
    if field.selector < 0:
        return field.cases[0]
    selector = message.variant.fields[field.selector]
    offset = start + message.variant.start(field.selector)
    selected = selector.cases[0].numbers[0].unpack(data, offset)
    case = field.case(selected)
    if case is None:
        raise reject_raw(message.command, selector, selector.cases[0], 0, selected, offset, data)
    return case


def _numbers(
    message: MessageVariant, field: Field, case: Case, offset: int, data: bytes
) -> tuple[int | float, ...]:
    values: list[int | float] = []
    for index, number in enumerate(case.numbers):
        raw = number.unpack(data, offset)
        if not field.allows(number, raw):
            raise reject_raw(message.command, field, case, index, raw, offset, data)
        values.append(number.physical(raw))
        offset += number.step
    return tuple(values)
