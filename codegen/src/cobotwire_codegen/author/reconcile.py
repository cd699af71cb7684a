"""Finds ids and lengths in a capture that the edition lacks, and drafts their entries."""

from __future__ import annotations

import re
from bisect import bisect
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from typing import Any

from cobotwire_codegen.author.guess import Guess, guess
from cobotwire_codegen.author.pcapng import MAGIC, Packet, packets
from cobotwire_codegen.author.scan import Seen, known_variants, scan
from cobotwire_codegen.author.values import fitting, known_values, pairs
from cobotwire_codegen.model import Edition

_HEX = re.compile(rb"[0-9A-Fa-fxX\s,]*\Z")
_EXAMPLES = 3


@dataclass(frozen=True, slots=True)
class News:
    """Messages of one id, length and direction that the edition lacks."""

    why: str
    frames: tuple[Seen, ...]
    guesses: tuple[Guess, ...]
    # For each guess, the type that its values fit, and why.
    types: tuple[tuple[str, str], ...]
    # ``stores`` if another message reports its value, ``reports`` if another message stores it.
    effect: str
    other: int

    @property
    def id(self) -> int:
        """The command id."""
        return self.frames[0].id

    @property
    def data_bytes(self) -> int:
        """The number of data bytes of the messages."""
        return len(self.frames[0].data)

    @property
    def examples(self) -> list[str]:
        """A few different frames, in hex."""
        differing = dict.fromkeys(seen.frame for seen in self.frames)
        return [frame.hex(" ").upper() for frame in list(differing)[:_EXAMPLES]]


def captured(given: bytes, direction: str) -> list[Packet]:
    """Return the packets of a capture; raw bytes and hex text are one packet.

    ``direction`` is that of the packets for which the capture states none.

    Raises:
        ValueError: the hex text has half a byte, or the pcapng file is damaged.
    """
    if given.startswith(MAGIC):
        found = packets(given)
        return [p._replace(direction=direction) if p.direction == "both" else p for p in found]
    if _HEX.match(given):
        given = bytes.fromhex(re.sub("0[xX]|,", " ", given.decode("ascii")))
    return [Packet(0, direction, given)]


def reconcile(edition: Edition, capture: Sequence[Packet]) -> tuple[int, list[News]]:
    """Return the number of frames in a capture, and the messages that the edition lacks."""
    known = {packet.direction: known_variants(edition, packet.direction) for packet in capture}
    ids = {command.id: command.name for command in edition.commands}
    groups: dict[tuple[int, int, str], list[Seen]] = {}
    frames = sorted(_frames(edition, capture, known), key=lambda seen: seen.offset)
    for seen in frames:
        if (seen.id, len(seen.data)) not in known[seen.direction]:
            groups.setdefault(seen.kind, []).append(seen)
    values = known_values(edition, frames) if groups else {}
    effects: dict[tuple[int, int, str], tuple[str, int]] = {}
    for stored, reported in pairs([*groups.values()]):
        effects.setdefault(stored.kind, ("stores", reported.id))
        effects.setdefault(reported.kind, ("reports", stored.id))
    found = []
    for key, seen_frames in sorted(groups.items()):
        kind = "message" if key[2] == "both" else key[2]
        why = (
            f"{ids[key[0]]} has no {kind} of this length" if key[0] in ids else "the id is unknown"
        )
        guesses = guess([seen.data for seen in seen_frames])
        types = tuple(fitting(edition, item, seen_frames, values) for item in guesses)
        effect, other = effects.get(key, ("", 0))
        found.append(News(why, tuple(seen_frames), tuple(guesses), types, effect, other))
    return len(frames), found


def _frames(
    edition: Edition, capture: Sequence[Packet], known: dict[str, set[tuple[int, int]]]
) -> Iterator[Seen]:
    """Yield the frames of each direction of each port; offsets count the bytes of all packets."""
    streams: dict[tuple[int, str], list[tuple[int, bytes]]] = {}
    at = 0
    for packet in capture:
        streams.setdefault(packet[:2], []).append((at, packet.data))
        at += len(packet.data)
    for (_, direction), pieces in streams.items():
        starts = [0, *accumulate(len(data) for _, data in pieces)]
        for seen in scan(edition, b"".join(data for _, data in pieces), known[direction]):
            index = bisect(starts, seen.offset) - 1
            offset = pieces[index][0] + seen.offset - starts[index]
            yield replace(seen, offset=offset, direction=direction)


def draft_lines(edition: Edition, news: News) -> Iterator[str]:
    """Return a draft of the entry in the commands file."""
    yield f"# GUESSED from {len(news.frames)} frame(s); {news.why}."
    yield from (f"# Seen: {example}" for example in news.examples)
    yield f"unknown_{news.id:02x}_{news.data_bytes}:"
    yield f"  id: 0x{news.id:02X}"
    yield f"  title: Unknown 0x{news.id:02X}"
    yield "  doc: Unknown."
    if news.effect == "reports":
        yield f"  safety: query  # its values are always those that 0x{news.other:02X} has set"
    else:
        yield "  safety: persistent write  # the strictest class, until it is known"
    if news.effect:
        yield from _effect(news)
    if news.guesses:
        reply = news.frames[0].direction == "reply" or news.effect == "reports"
        unsure = news.frames[0].direction == "both" and not news.effect
        note = "  # or reply: the capture does not show which" if unsure else ""
        yield f"  {'reply' if reply else 'request'}:{note}"
    yield from (line for pair in zip(news.guesses, news.types) for line in _fields(edition, *pair))


def _effect(news: News) -> Iterator[str]:
    """Yield the effect of a message that sets or reports the same state as another one."""
    state = min(news.id, news.other)
    yield f"  effect:  # GUESSED; declare the state, see 0x{news.other:02X}"
    yield f"    {news.effect}:"
    for item in news.guesses:
        name = f"{item.kind if item.kind != 'text' else 'byte'}_{item.first}"
        yield f"      {name}: state_{state:02x}_{item.first}"


def _fields(edition: Edition, item: Guess, typed: tuple[str, str]) -> Iterator[str]:
    kind, width = (item.kind, item.width) if item.kind != "text" else ("byte", 1)
    type, why = typed
    for first in range(item.first, item.first + item.width, width):
        const = item.says.removeprefix("always ") if kind == "constant" else ""
        more = f", const: {const}" if const else ""
        name = f"{kind}_{first}"
        chosen = type or ("unknown_word" if kind == "word" else "unknown_byte")
        says = f"{item.says}; {why}" if why else item.says
        yield f"    - {{name: {name}, type: {chosen}{more}}}  # guess: {says}"


def plain(news: News, draft: list[str]) -> dict[str, Any]:
    """Return the message as data for JSON."""
    return {
        "id": news.id,
        "data_bytes": news.data_bytes,
        "direction": news.frames[0].direction,
        "why": news.why,
        "count": len(news.frames),
        "offsets": [seen.offset for seen in news.frames[:_EXAMPLES]],
        "examples": news.examples,
        "guesses": [
            {"first": item.first, "width": item.width, "kind": item.kind, "says": item.says}
            | {"type": type, "why": why}
            for item, (type, why) in zip(news.guesses, news.types)
        ],
        "draft": "\n".join(draft),
    }
