"""Explain one entry byte by byte: raw and physical values, the spec's line, its errata."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cobotwire.codec.interface import Codec, DecodedMessage
from cobotwire.diagnose import Finding
from cobotwire.diagnose.explain import Part, frame_parts
from cobotwire.editions import Edition
from cobotwire.protocol.loading import load_sources
from cobotwire.protocol.table import Command
from cobotwire.studio.describing import Describer, frame_of
from cobotwire.studio.entries import Entry

Explanation = dict[str, Any]


class Explainer:
    """Explains entries of one edition."""

    def __init__(self, edition: Edition, codec: Codec) -> None:
        self._sources = load_sources(getattr(edition, "__name__", ""))
        self._codec = codec
        self._describer = Describer(codec)

    def explain(self, entry: Entry) -> Explanation:
        """Return the explanation as JSON values."""
        message, error = self._describer.read(entry)
        explained: Explanation = {
            "time": entry.time,
            "direction": entry.direction,
            "hex": _hex(entry.data),
            "text": entry.remark,
        }
        if entry.finding is not None:
            explained |= _finding(entry.finding)
        elif message is not None:
            explained |= self._message(entry, message)
        elif error is not None:
            explained |= {"text": str(error)}
        return explained

    def frame(self, data: bytes) -> Explanation:
        """Return the explanation of a request that is not sent yet."""
        return self.explain(Entry(0.0, "sent", data))

    def _message(self, entry: Entry, message: DecodedMessage) -> Explanation:
        command, frame = message.command, frame_of(self._codec, entry)
        parts = [_part(part) for part in frame_parts(self._codec.table, frame, message)]
        if text := entry.data[len(frame) :]:
            part = Part(len(frame), text, "text", ascii(text.decode("latin-1")))
            parts.append(_part(part))
        return {"parts": parts, "command": about(command, self._sources)}


def about(command: Command, sources: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the spec says about a command; ``sources`` are those of the edition."""
    return {
        "name": command.name,
        "title": command.title,
        "doc": command.doc,
        "safety": command.safety,
        "notes": list(command.notes),
        **sources.get(command.name, {}),
    }


def _part(part: Part) -> dict[str, Any]:
    raw = None if part.raw is None else str(part.raw)
    return {
        "at": part.offset,
        "hex": _hex(part.data),
        "name": part.name,
        "raw": raw,
        "meaning": part.meaning,
    }


def _finding(finding: Finding) -> Explanation:
    # Facts that are false or unknown are left out.
    facts = {
        name: text
        for name, value in finding.facts.items()
        if value is not None and (text := _fact(value))
    }
    return {
        "noise": finding.kind,
        "text": finding.describe(),
        "reason": finding.reason,
        "advice": finding.advice,
        "facts": facts,
    }


def _fact(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else ""
    if isinstance(value, tuple | list):
        return ", ".join(map(str, value))
    return _hex(value) if isinstance(value, bytes) else str(value)


def _hex(data: bytes) -> str:
    return data.hex(" ").upper()
