"""Checks what an owner's file states against the edition, and writes it as a file of evidence."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace

from cobotwire_codegen.author.draft import read, vector_lines
from cobotwire_codegen.author.scan import Seen, known_variants, scan
from cobotwire_codegen.evidence.submitted import NotEvidence, Reported, Submitted
from cobotwire_codegen.facts import DIRECTIONS, ON_AN_ARM, facts_of, parts_of
from cobotwire_codegen.model import Command, Edition
from cobotwire_codegen.model.frame import Direction

# Each id and data length of the edition, by direction.
Known = dict[Direction, set[tuple[int, int]]]
# The most vectors of one message that are taken: more show little that is new.
_MOST_VECTORS = 3
_MOST_SHOWN = 2
_HEAD = (
    "# yaml-language-server: $schema=../schema.json",
    "# What a real arm showed: written by `cobotwire-gen evidence add`, and not to be edited.",
)


@dataclass(slots=True)
class Entry:
    """The facts and frames that are taken from a file, and why other facts are not."""

    taken: list[Reported] = field(default_factory=list)
    refused: dict[str, str] = field(default_factory=dict)
    vectors: list[list[str]] = field(default_factory=list)


def checked(edition: Edition, given: Submitted) -> Entry:
    """Return what an edition takes from a file.

    Raises:
        NotEvidence: the file is about another edition, was added before, or shows nothing.
    """
    if given.edition != edition.name:
        raise NotEvidence(f"the file is about {given.edition}, not about {edition.name}")
    before = [each.place.file for each in edition.observed if each.digest == given.digest]
    if before:
        raise NotEvidence(f"the file was added before: {before[0]}")
    made, facts = Entry(), facts_of(edition)
    known = {direction: known_variants(edition, direction) for direction in DIRECTIONS}
    for reported in given.facts:
        for fact in _expanded(reported, facts):
            reason = _refused(edition, fact, given.line, known)
            if reason:
                made.refused[fact.fact] = reason
            else:
                made.taken.append(fact)
    if not made.taken:
        reasons = "; ".join(dict.fromkeys(made.refused.values())) or "it states no fact"
        raise NotEvidence(f"the file shows nothing about {edition.name}: {reasons}")
    made.vectors = [
        *_vectors(edition, made.taken, known, f"{given.kind.split()[0]}-{given.digest[:8]}")
    ]
    return made


def _expanded(fact: Reported, known: Iterable[str]) -> Iterator[Reported]:
    """Yield a fact; for ``reply.*``, yield the known fact about each field instead."""
    before, star, aspect = fact.fact.partition("*")
    if not star:
        yield fact
    for name in known if star else ():
        own = name.partition("/")[2]
        if own.startswith(before) and own.endswith(aspect):
            yield replace(fact, fact=own)


def _refused(edition: Edition, fact: Reported, line: bytes | None, known: Known) -> str:
    """Return why a fact is not taken; empty if it is."""
    name, part, _ = fact.fact.split("/")
    command = edition.by_name.get(name)
    if command is None or part not in parts_of(command):
        return "the edition has no such part"
    if command.text is not None or command.request_text is not None:
        return "its text may be private"
    frames = [each for pair in fact.frames for each in pair if each]
    if not frames:
        return "no frame shows it"
    if line is not None and not all(frame in line for frame in frames):
        return "its frames are not in the recording"
    if fact.confirmed and not _shows(edition, command, fact, known):
        return "its frames are not frames of the command"
    return ""


def _shows(edition: Edition, command: Command, fact: Reported, known: Known) -> bool:
    """Return whether a frame is the message that a confirmed fact is about.

    The effect of a command shows in the reply to a query, so its frames belong to another command.
    """
    _, part, aspect = fact.fact.split("/")
    replied = part.startswith("reply") or (command.awaits_reply and command.text is None)
    wanted: Direction = "reply" if replied else "request"
    elsewhere = aspect in ON_AN_ARM
    return any(
        elsewhere or (direction == wanted and seen.id == command.id)
        for pair in fact.frames
        for direction, seen in _frames(edition, pair, known)
        if (seen.id, len(seen.data)) in known[direction]
    )


def _vectors(
    edition: Edition, facts: list[Reported], known: Known, name: str
) -> Iterator[list[str]]:
    """Yield a vector for each new frame that the edition reads.

    Frames of a command with a contradicted fact are left out, since they prove nothing.
    """
    held = {(vector.command, vector.frame) for vector in edition.vectors}
    doubted = {fact.fact.partition("/")[0] for fact in facts if not fact.confirmed}
    shown: Counter[tuple[str, Direction]] = Counter()
    for fact in facts:
        command = edition.by_name[fact.fact.partition("/")[0]]
        for pair in fact.frames if command.name not in doubted else ():
            for direction, seen in _frames(edition, pair, known):
                key, frame = (command.name, direction), seen.frame
                if (command.name, frame) in held or shown[key] == _MOST_VECTORS:
                    continue
                held.add((command.name, frame))
                with suppress(ValueError):
                    values = read(edition, command, direction, frame)
                    shown[key] += 1
                    numbered = f"{name}-{shown.total()}"
                    yield vector_lines(numbered, command.name, direction, frame, values, seen=True)


def _frames(
    edition: Edition, pair: tuple[bytes, bytes], known: Known
) -> Iterator[tuple[Direction, Seen]]:
    """Yield the frames in what was sent and received."""
    for direction, data in zip(DIRECTIONS, pair):
        yield from ((direction, seen) for seen in scan(edition, data, known[direction]))


def text_of(given: Submitted, entry: Entry) -> str:
    """Return the YAML of the file of evidence."""
    lines = [*_HEAD, f"evidence: {given.edition}", f"kind: {given.kind}"]
    heads = {"robot": given.robot, "firmware": given.firmware, "date": given.day}
    lines += [f"{key}: {_quoted(text)}" for key, text in heads.items() if text]
    lines += [f"digest: {_quoted(given.digest)}", "facts:"]
    for fact in entry.taken:
        verdict = "confirmed" if fact.confirmed else "contradicted"
        lines.append(f"  - {{fact: {fact.fact}, verdict: {verdict}{_shown(fact)}}}")
    if entry.vectors:
        lines.append("vectors:")
        lines += [f"  {line}" for vector in entry.vectors for line in vector]
    return "\n".join(lines) + "\n"


def _shown(fact: Reported) -> str:
    """Return why a fact is contradicted, and the last frame of each exchange, as YAML."""
    if fact.confirmed:
        return ""
    why = f", why: {_quoted(fact.why)}" if fact.why else ""
    frames = [received or sent for sent, received in fact.frames][:_MOST_SHOWN]
    shown = ", ".join(_quoted(frame.hex(" ").upper()) for frame in frames)
    return f"{why}, frames: [{shown}]"


def _quoted(text: str) -> str:
    """Return printable text as YAML. A JSON string is a YAML string too."""
    return json.dumps(text, ensure_ascii=False)
