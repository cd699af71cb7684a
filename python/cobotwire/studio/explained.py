"""Explain one entry byte by byte: raw and physical values, the spec's line, its errata."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from cobotwire.codec.interface import Codec, DecodedMessage
from cobotwire.diagnose import Finding
from cobotwire.diagnose.explain import Part, frame_parts
from cobotwire.editions import Edition
from cobotwire.protocol.errors import UsageError
from cobotwire.studio.describing import Describer, frame_of
from cobotwire.studio.entries import Entry

Explanation = dict[str, Any]


class Explainer:
    """Explains entries of one edition."""

    def __init__(self, edition: Edition, codec: Codec) -> None:
        self._sources = sources_of(edition)
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
        return {
            "parts": parts,
            "command": {
                "name": command.name,
                "title": command.title,
                "doc": command.doc,
                "safety": command.safety,
                "notes": list(command.notes),
                **self._sources.get(command.name, {}),
            },
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
    # What is not so, or not known, says nothing.
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


def sources_of(edition: Edition) -> Mapping[str, Any]:
    """Return where each command is described: its place in the spec, lines, errata, disputes.

    Empty for a package that an older cobotwire-gen built.

    Raises:
        UsageError: the file is damaged.
    """
    return _read_sources(str(Path(getattr(edition, "__file__", "")).parent / "sources.json"))


@lru_cache
def _read_sources(path: str) -> Mapping[str, Any]:
    try:
        found = json.loads(Path(path).read_text(encoding="utf-8"))["commands"]
    except OSError:
        return {}
    except (ValueError, LookupError, TypeError, RecursionError):
        found = None
    if not isinstance(found, dict) or not all(isinstance(each, dict) for each in found.values()):
        message = f"{path} is damaged; generate the package again with cobotwire-gen"
        raise UsageError("edition", path, message=message)
    return found
