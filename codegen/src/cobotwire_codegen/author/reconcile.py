"""Finds ids and lengths in a capture that the edition lacks, and drafts their entries."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from cobotwire_codegen.author.guess import Guess, guess
from cobotwire_codegen.author.scan import Seen, known_variants, scan
from cobotwire_codegen.model import Edition

_HEX = re.compile(rb"[0-9A-Fa-fxX\s,]*\Z")
_EXAMPLES = 3


@dataclass(frozen=True, slots=True)
class News:
    """Messages of one id and length that the edition lacks."""

    why: str
    frames: tuple[Seen, ...]
    guesses: tuple[Guess, ...]

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


def capture_bytes(given: bytes) -> bytes:
    """Return the bytes of a capture that is raw or hex text.

    Raises:
        ValueError: the hex text has half a byte.
    """
    if not _HEX.match(given):
        return given
    return bytes.fromhex(re.sub("0[xX]|,", " ", given.decode("ascii")))


def reconcile(edition: Edition, line: bytes, direction: str) -> tuple[int, list[News]]:
    """Return the number of frames in a capture, and the messages that the edition lacks."""
    known = known_variants(edition, direction)
    ids = {command.id: command.name for command in edition.commands}
    groups: dict[tuple[int, int], list[Seen]] = {}
    count = 0
    for seen in scan(edition, line, known):
        count += 1
        if (seen.id, len(seen.data)) not in known:
            groups.setdefault((seen.id, len(seen.data)), []).append(seen)
    found = []
    for (id, _), frames in sorted(groups.items()):
        why = f"{ids[id]} has no such length" if id in ids else "the id is unknown"
        guesses = guess([seen.data for seen in frames])
        found.append(News(why, tuple(frames), tuple(guesses)))
    return count, found


def draft_lines(edition: Edition, news: News, direction: str) -> Iterator[str]:
    """Return a draft of the entry in the commands file."""
    yield f"# GUESSED from {len(news.frames)} frame(s); {news.why}."
    yield from (f"# Seen: {example}" for example in news.examples)
    yield f"unknown_{news.id:02x}_{news.data_bytes}:"
    yield f"  id: 0x{news.id:02X}"
    yield f"  title: Unknown 0x{news.id:02X}"
    yield "  doc: Unknown."
    yield "  safety: persistent write  # the strictest class, until it is known"
    if news.guesses:
        note = "  # or reply: the capture does not show which" if direction == "both" else ""
        yield f"  {'reply' if direction == 'reply' else 'request'}:{note}"
    yield from (line for item in news.guesses for line in _fields(edition, item))


def _fields(edition: Edition, item: Guess) -> Iterator[str]:
    kind, width = (item.kind, item.width) if item.kind != "text" else ("byte", 1)
    for first in range(item.first, item.first + item.width, width):
        const = item.says.removeprefix("always ") if kind == "constant" else ""
        more = f", const: {const}" if const else ""
        name = f"{kind}_{first}"
        yield f"    - {{name: {name}, type: {_type(edition, kind)}{more}}}  # guess: {item.says}"


def _type(edition: Edition, kind: str) -> str:
    """Return a type of the edition that fits, or a name that the checker will report."""
    width = 2 if kind == "word" else 1
    for type in edition.types:
        if kind == type.kind == "flag":
            return type.name
        if kind != "flag" and type.can_hold_any(width):
            return type.name
    return "unknown_word" if kind == "word" else "unknown_byte"


def plain(news: News, draft: list[str]) -> dict[str, Any]:
    """Return the message as data for JSON."""
    return {
        "id": news.id,
        "data_bytes": news.data_bytes,
        "why": news.why,
        "count": len(news.frames),
        "offsets": [seen.offset for seen in news.frames[:_EXAMPLES]],
        "examples": news.examples,
        "guesses": [
            {"first": item.first, "width": item.width, "kind": item.kind, "says": item.says}
            for item in news.guesses
        ],
        "draft": "\n".join(draft),
    }
