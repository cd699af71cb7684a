"""Rules for bytes: all that a client sends is whole, legal frames, one after the other."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.codec.interface import Codec, Noise, NoiseReason
from cobotwire.conformance.client.past import Heard, Past
from cobotwire.conformance.client.rules.rule import Judgement, rule
from cobotwire.errors import ProtocolError
from cobotwire.session.device import Asked, Malformed

FRAMING = "docs/framing.md"


def _noise_of(now: Heard, reason: NoiseReason) -> Judgement:
    if not isinstance(now.event, Noise):
        return ""
    if now.event.reason != reason:
        return None
    return f"{now.data.hex(' ').upper()}"


@rule("frame-length", "LEN is legal for the command", FRAMING)
def frame_length(past: Past, now: Heard) -> Judgement:
    """A header whose LEN the command cannot have."""
    found = _noise_of(now, "bad-length")
    return found and f"a header with a LEN that its command cannot have: {found}"


@rule("frame-id", "the id is one that the edition has", FRAMING)
def frame_id(past: Past, now: Heard) -> Judgement:
    """A header with an id of no command."""
    found = _noise_of(now, "unknown-id")
    return found and f"a header with an id that the edition lacks: {found}"


@rule("frame-footer", "a frame ends with its footer, or the right check", FRAMING)
def frame_footer(past: Past, now: Heard) -> Judgement:
    """A frame with another end."""
    found = _noise_of(now, "bad-check")
    return found and f"a frame that does not end as it must: {found}"


@rule("frame-address", "the address byte is one that the edition has", FRAMING)
def frame_address(past: Past, now: Heard) -> Judgement:
    """A frame for nobody."""
    found = _noise_of(now, "bad-address")
    return found and f"a header with an address that the edition lacks: {found}"


@rule("frame-whole", "a frame is sent whole, without a pause", FRAMING)
def frame_whole(past: Past, now: Heard) -> Judgement:
    """A frame that broke off."""
    found = _noise_of(now, "truncated")
    return found and f"a frame that broke off: {found}"


@rule("stray-bytes", "no byte stands outside a frame", FRAMING)
def stray_bytes(past: Past, now: Heard) -> Judgement:
    """Bytes that begin no frame; but for the rest of one that was broken, and for a text."""
    found = _noise_of(now, "no-header")
    if not found:
        return found
    last = past.last
    if past.text_due() is not None or (last is not None and isinstance(last.event, Noise)):
        return None
    return f"bytes outside any frame: {found}"


@rule("interleaved-write", "no frame is written into another one", "field notes: two writers")
def interleaved_write(past: Past, now: Heard) -> Judgement:
    """Take one legal frame out of the bytes, and what is left is another."""
    if not isinstance(now.event, Noise):
        return ""
    stretch = _stretch(past, now)
    for start in range(len(stretch)):
        for outer, inner in _pairs(past.codec, stretch[start:]):
            return f"{inner.hex(' ').upper()} was written into {outer.hex(' ').upper()}"
    return ""


def _stretch(past: Past, now: Heard) -> bytes:
    """The last bytes up to now, as many as two frames can have."""
    data = now.data
    frame = past.codec.table.frame
    most = 2 * (frame.overhead + frame.maximum_length)
    for each in past.backwards(now.at - 1.0):
        data = each.data + data
        if len(data) > most:
            break
    return data[-most:]


def _pairs(codec: Codec, data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """What ``data``, all of it, is made of, if it is one frame written into another."""
    frame = codec.table.frame
    if not data.startswith(frame.header):
        return
    for at in range(1, len(data) - frame.overhead):
        if data[at : at + len(frame.header)] != frame.header:
            continue
        end = at + frame.overhead + data[at + frame.length_at]
        outer, inner = data[:at] + data[end:], data[at:end]
        if end < len(data) and _legal(codec, inner) and _legal(codec, outer):
            yield outer, inner


def _legal(codec: Codec, data: bytes) -> bool:
    try:
        codec.decode("request", data)
    except ProtocolError:
        return False
    return True


@rule("text-follows", "the text of a request follows it at once", "spec: request text")
def text_follows(past: Past, now: Heard) -> Judgement:
    """A request whose text is sent outside any frame, and another one before that text."""
    if not isinstance(now.event, Asked | Malformed):
        return None
    due = past.text_due()
    if due is None or due.command is None:
        return None
    return f"{due.command.name} lacks the text behind it, or it cannot be read"
