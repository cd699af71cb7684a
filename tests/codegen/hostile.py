"""A spec with every kind of text, as plain data, and strings that attack its outputs."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML

Path_ = tuple[str | int, ...]

LAMP = Path(__file__).parent / "lamp.yaml"
EXTRA = """
frame:
  frame: {check: sum, addresses: {LEFT: {value: 1, doc: The left one.}}, source: [1-2]}
document: A document.
firmware: Firmware 1.
errata:
  - {line: 3, kind: text, commands: [tell], says: Tells., read: It tells., why: It does.}
  - {line: 4, kind: text, says: Frames., read: Bytes., why: They are.}
evidence:
  - evidence: lamp
    kind: survey
    robot: A lamp.
    firmware: "1"
    date: "2026-11-24"
    digest: abc
    facts:
      - {fact: tell/reply/length, verdict: contradicted, why: It is longer., frames: [FE FE]}
"""
COMMAND = """
id: 0x50
title: Log in
doc: Sends an account.
safety: persistent write
notes: [Choose it well.]
request_text:
  text: "'{account}'({password})"
  fields:
    - {name: account, doc: The account.}
    - {name: password, doc: The password.}
"""
VECTOR = "{name: log in, command: log_in, direction: request, frame: FE FE 02 50 FA, values: {}}"

# Texts that end or open a construct in a target language, a terminal or a browser.
PAYLOADS = (
    'EVIL"""\nraise SystemExit(3)\n"""',
    "EVIL*/ static int evil(void){return 1;} /*",
    "EVIL]] os.execute() --[[",
    "EVIL<script>alert(1)</script>",
    "EVIL</script>",
    "EVIL{{ 7*7 }}{% raw %}",
    "EVIL%s%n%(x)s",
    "EVIL\x00",
    "EVIL\x1b[2J",
    "EVIL\u202egnp.exe",
    "EVIL\ud800",
    "EVIL\u2028x",
    "EVIL\r\nx",
    "EVIL`| x |`[a](javascript:alert)",
    'EVIL"\\',
    "EVIL\\",
    "EVIL'''",
    "EVIL\nimport os",
    "EVIL??/",
    "self",
    "class",
    "stream",
    "None",
    "int",
    "messages",
    "../EVIL",
)


def spec() -> dict[str, Any]:
    """Return the spec: the lamp with addresses, errata, and text after a request."""
    load = YAML(typ="safe", pure=True).load
    made: dict[str, Any] = load(LAMP)
    extra = load(EXTRA)
    frame = made["frame"]["frame"]
    del frame["footer"]
    frame.update(extra.pop("frame")["frame"])
    frame["length_counts"] = ["command", "data", "check"]
    made.update(extra)
    made["commands"]["log_in"] = load(COMMAND)
    made["vectors"].append(load(VECTOR))
    for vector in made["vectors"]:
        if "frame" in vector:
            data = bytes.fromhex(vector["frame"])[3:-1]
            body = bytes([1, len(data) + 1, *data, sum(data) % 256])
            vector["frame"] = (b"\xfe\xfe" + body).hex(" ").upper()
    return made


def slots(node: Any, path: Path_ = ()) -> Iterator[tuple[Path_, bool]]:
    """Return the path of each text, and whether the text is a key."""
    if isinstance(node, dict):
        for key, value in node.items():
            yield (*path, key), True
            yield from slots(value, (*path, key))
    elif isinstance(node, list):
        for index, value in enumerate(node):
            yield from slots(value, (*path, index))
    elif isinstance(node, str):
        yield path, False


def replaced(whole: dict[str, Any], path: Path_, is_key: bool, by: str) -> dict[str, Any]:
    """Return the spec with the text at a path replaced."""
    changed = copy.deepcopy(whole)
    inner: Any = changed
    for step in path[:-1]:
        inner = inner[step]
    if is_key:
        entries = [(by if key == path[-1] else key, value) for key, value in inner.items()]
        inner.clear()
        inner.update(entries)
    else:
        inner[path[-1]] = by
    return changed


def renamed(node: Any, old: str, new: str) -> Any:
    """Return the spec with a name replaced wherever it occurs."""
    if isinstance(node, dict):
        return {renamed(key, old, new): renamed(value, old, new) for key, value in node.items()}
    if isinstance(node, list):
        return [renamed(item, old, new) for item in node]
    return new if node == old else node


def as_yaml(whole: dict[str, Any]) -> str:
    """Return the spec as JSON, which YAML reads; every character can be written in it."""
    return json.dumps(whole, indent=1)
