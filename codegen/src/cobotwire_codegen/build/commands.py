"""Builds the commands of a family."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from cobotwire_codegen import language
from cobotwire_codegen.build.effects import build_effect
from cobotwire_codegen.build.fields import build_field, build_variants
from cobotwire_codegen.build.parts import FamilyParts, Parts
from cobotwire_codegen.build.read_back import build_samples
from cobotwire_codegen.build.text import build_reply_text, build_request_text
from cobotwire_codegen.build.types import Types, disputes, evidence
from cobotwire_codegen.errors import Place, Problem
from cobotwire_codegen.language.shapes import items_of
from cobotwire_codegen.load import Node, Scalar
from cobotwire_codegen.model import Command, Family, Firmware, Variant
from cobotwire_codegen.model.commands import NoId
from cobotwire_codegen.reader import Reader


def build_family(
    family: FamilyParts, parts: Parts, types: Types, deadline_ms: int, problems: list[Problem]
) -> Family:
    """Return a family with its commands."""
    acks = _Acks(parts, types, problems)
    commands = [
        _command(name, place, node, parts, types, acks, deadline_ms, problems)
        for name, (place, node) in family.commands.items()
    ]
    return Family(family.place, family.name, family.title, family.doc, tuple(commands))


def build_accepted(
    node: Node | None, replies: tuple[Variant, ...], reader: Reader
) -> tuple[int, ...]:
    """Return the raw values with which a reply's last field reports success."""
    if node is None:
        return ()
    subject = f"accepted of {reader.what}"
    status = replies[0][-1] if replies and replies[0] else None
    raws = {} if status is None else {m.name: m.value for m in status.type.members}
    found = []
    for item in items_of(node, subject, reader.problem):
        value = item.value if isinstance(item, Scalar) else None
        raw = raws.get(value) if isinstance(value, str) else value
        if isinstance(raw, bool) or not isinstance(raw, int):
            message = f"{subject} must list members or raw numbers of the last field of the reply"
            reader.problem("wrong-kind", message, item.place)
        else:
            found.append(raw)
    return tuple(found)


class _Acks:
    """The edition's rule for commands that have no reply of their own."""

    def __init__(self, parts: Parts, types: Types, problems: list[Problem]) -> None:
        self.variants: tuple[Variant, ...] = ()
        self.accepted: tuple[int, ...] = ()
        self._except = set(parts.unacknowledged)
        if parts.acks is None:
            return
        spec = language.Acks
        reader = Reader(parts.acks, spec, "the acks", problems)
        field, fields = reader.get(spec.field), reader.get(spec.fields)
        if field is None and not fields:
            reader.problem("missing-key", "the acks lack the key field or fields")
        self._accepted = reader.get(spec.accepted)
        self._reader = reader
        listed = reader.get(spec.except_)
        self._except |= set(listed)
        reader.get(spec.why)
        known = set(parts.commands())
        for name in listed:
            if name not in known and name not in parts.gone:
                reader.problem("unknown-command", f"there is no command {name}")
        if field is not None:
            # Arms have been observed to send either this one field or a frame without data.
            self.variants = ((build_field(field, "reply", reader, types),), ())
        elif fields:
            full = tuple(build_field(node, "reply", reader, types) for node in fields)
            self.variants = (full,)
        self.accepted = build_accepted(self._accepted, self.variants, reader)

    def of(self, name: str) -> tuple[Variant, ...]:
        """Return the acknowledgement of a command that has no other reply."""
        return () if name in self._except else self.variants


def _id(reader: Reader) -> int:
    """Return the id; a stand-in if it is missing or wrong."""
    before = len(reader.problems)
    id = reader.get(language.Command.id)
    wrong = reader.node(language.Command.id) is None or len(reader.problems) > before
    return NoId() if wrong else id


def _command(
    name: str,
    place: Place,
    node: Node,
    parts: Parts,
    types: Types,
    acks: _Acks,
    deadline_ms: int,
    problems: list[Problem],
) -> Command:
    spec = language.Command
    reader = Reader(node, spec, f"the command {name}", problems)
    replies = build_variants(reader, "reply", types)
    text = build_reply_text(reader, spec.reply_text)
    ack = reader.get(spec.ack)
    if not replies and text is None and not reader.get(spec.event):
        replies = acks.of(name)
        ack = bool(replies)
        accepted = acks.accepted if ack else ()
    else:
        accepted = build_accepted(reader.get(spec.accepted), replies, reader)
    event = reader.get(spec.event)
    firmware = _firmware(reader)
    command = Command(
        place=place,
        id=_id(reader),
        name=name,
        title=reader.get(spec.title),
        doc=reader.get(spec.doc),
        safety=reader.get(spec.safety),
        role=reader.get(spec.role),
        source=reader.get(spec.source),
        deadline_ms=reader.get(spec.deadline_ms) or deadline_ms,
        requests=build_variants(reader, "request", types) or (() if event else ((),)),
        replies=replies,
        ack=ack,
        event=event,
        accepted=accepted,
        alias=reader.get(spec.alias),
        shares_id=reader.get(spec.shares_id),
        text=text,
        request_text=build_request_text(reader, spec.request_text),
        read_by=None,
        samples=build_samples(reader),
        agrees_with=reader.get(spec.agrees_with),
        notes=(*reader.get(spec.notes), *_firmware_notes(firmware)),
        disputed=disputes(reader, spec.disputed),
        changes=tuple(parts.changes.get(name, ())),
        arguments=reader.get(spec.arguments),
        firmware=firmware,
    )
    effect = build_effect(reader.get(spec.effect), command, problems)
    return replace(command, effect=effect)


# The sentences about each kind of version.
FIRMWARE_WORDS = {
    "since": "It needs firmware {} or later",
    "until": "Firmware {} removed it",
    "reply_since": "It gets a reply since firmware {}",
}


def _firmware(outer: Reader) -> Firmware | None:
    node = outer.get(language.Command.firmware)
    if node is None:
        return None
    spec = language.Firmware
    reader = Reader(node, spec, f"the firmware of {outer.what}", outer.problems)
    found = Firmware(
        reader.get(spec.since),
        reader.get(spec.until),
        reader.get(spec.reply_since),
        evidence(reader, spec.evidence),
    )
    if not found.versions:
        reader.problem("missing-key", f"{reader.what} lacks one of {', '.join(FIRMWARE_WORDS)}")
    return found


def _firmware_notes(firmware: Firmware | None) -> Iterator[str]:
    """Yield a sentence for each version, with what the sources state."""
    if firmware is not None:
        sources = "; ".join(f"{each.source}: {each.says}" for each in firmware.evidence)
        for key, version in firmware.versions.items():
            yield f"{FIRMWARE_WORDS[key].format(f'{float(version):.1f}')} ({sources})."
