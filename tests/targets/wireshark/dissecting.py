"""Run tshark with our dissectors on a capture, and return what it shows as records."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import pytest

import framed_events
from cobotwire.codec.interface import Codec, Event, Frame, Listening
from cobotwire_codegen.targets.wireshark.fields import OWN
from strategies import TABLES
from targets.built import built

# The name of an item that has a text but no field.
TEXT = "_ws.lua.text"
ABSENT = "tshark is not installed (Debian: apt install tshark)"
# The events of the codec so far, and the number of bytes that wait.
Truth = tuple[list[Event], int]
needs_tshark = pytest.mark.skipif(shutil.which("tshark") is None, reason=ABSENT)


@dataclass
class Leaf:
    """A value in the tree: its filter name, its value, its label, its bytes."""

    filter: str
    value: str
    label: str
    data: bytes


@dataclass
class Item:
    """A frame, a span of noise (``kind`` is its reason), or incomplete bytes."""

    kind: str
    data: bytes
    label: str
    own: dict[str, str]
    leaves: list[Leaf] = field(default_factory=list)
    experts: list[str] = field(default_factory=list)


def tshark(capture: Path, *words: str, scripts: list[Path] | None = None) -> str:
    """Return what tshark prints; fail if one of our scripts has an error."""
    # If several dissectors are registered for one TCP port, Wireshark uses the last one loaded:
    # that of the 280.
    usual = [built("wireshark") / f"{edition}.lua" for edition in sorted(TABLES)]
    used = usual if scripts is None else scripts
    loaded = [word for script in used for word in ("-X", f"lua_script:{script}")]
    result = subprocess.run(
        ["tshark", "-n", *loaded, "-r", str(capture), *words],
        capture_output=True,
        text=True,
        check=False,
        # Ignore the user's plugins and preferences.
        env={**os.environ, "WIRESHARK_CONFIG_DIR": str(capture.parent)},
    )
    output = result.stdout + result.stderr
    assert "Lua" not in result.stderr, result.stderr
    assert "Lua Error" not in output
    assert "Dissector bug" not in output
    assert result.returncode == 0 or "cut short" in result.stderr, result.stderr
    return result.stdout


def dissected(
    capture: Path, edition: str, *words: str, scripts: list[Path] | None = None
) -> list[list[Item]]:
    """Return the items of each packet; ``edition`` may be several names with spaces between."""
    out = tshark(capture, "-T", "pdml", "-J", edition, *words, scripts=scripts)
    names = edition.split()
    return [
        [item for proto in packet if proto.get("name") in names for item in _items(proto)]
        for packet in ET.fromstring(out).iter("packet")
    ]


def joined(packets: list[list[Item]]) -> list[tuple[str, bytes]]:
    """Join the events of one direction, and noise of one reason also across packets.

    Incomplete bytes count only at the end of the line.
    """
    found: list[tuple[str, bytes]] = []
    for number, packet in enumerate(packets, 1):
        for item in packet:
            if item.kind == "incomplete" and number < len(packets):
                continue
            if found and found[-1][0] == item.kind != "frame":
                found[-1] = item.kind, found[-1][1] + item.data
            else:
                found.append((item.kind, item.data))
    return found


def events_of(codec: Codec, direction: Listening, chunks: Iterable[tuple[bytes, bool]]) -> Truth:
    """Return the codec's events of chunks, each given with whether silence follows it."""
    framer = codec.framer(direction)
    events: list[Event] = []
    for data, silent in chunks:
        events += framer.feed(data) + (framer.flush() if silent else [])
    return events, framer.pending


def summary(truth: Truth, data: bytes) -> list[tuple[str, bytes]]:
    """Return the codec's events in the form of :func:`joined`."""
    events, pending = truth
    found: list[tuple[str, bytes]] = [
        ("frame" if isinstance(event, Frame) else event.reason, event.data)
        for event in framed_events.joined(events)
    ]
    return [*found, ("incomplete", data[-pending:])] if pending else found


def _items(proto: ET.Element) -> Iterator[Item]:
    edition = proto.get("name", "")
    kinds = {f"{edition}.frame.bytes": "frame", f"{edition}.incomplete": "incomplete"}
    for element in proto:
        name = element.get("name", "")
        if name in kinds or name == f"{edition}.noise":
            item = Item(kinds.get(name, ""), _data(element), element.get("showname", ""), {})
            _fill(item, element, edition)
            item.kind = item.kind or item.own["noise.reason"]
            yield item


def _fill(item: Item, parent: ET.Element, edition: str) -> None:
    for element in parent:
        name = element.get("name", "")
        part = name.removeprefix(f"{edition}.")
        if name == "_ws.expert":
            item.experts += [e.get("name", "").removeprefix(f"{edition}.") for e in element[:1]]
            continue
        if part in OWN:
            item.own[part] = element.get("show", "")
        elif not _groups(element):
            words = element.get("show", ""), element.get("showname", "")
            item.leaves.append(Leaf(part, *words, _data(element)))
        _fill(item, element, edition)


def _groups(element: ET.Element) -> bool:
    """Return whether an element only groups others; an empty list has nothing to group."""
    # A name that fields of several kinds share has the kind as its suffix.
    name = re.sub(r"_(group|number|bytes|text)$", "", element.get("name", ""))
    inner = any(each.get("name", "").startswith(f"{name}.") for each in element.iter())
    return inner or name == TEXT or element.get("showname", "").endswith(": nothing")


def _data(element: ET.Element) -> bytes:
    # In a bit field, the unmasked value is the whole byte or word.
    return bytes.fromhex(element.get("unmaskedvalue") or element.get("value") or "")
