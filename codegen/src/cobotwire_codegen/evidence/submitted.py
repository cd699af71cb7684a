"""Reads an owner's file, a survey or a conformance report. It is untrusted until checked.

Every size is limited before memory is used, nothing is unpacked to a disk, and texts must be
printable. `entry` checks that the frames are frames of the edition.
"""

from __future__ import annotations

import io
import json
import re
import struct
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Any

from cobotwire_codegen.author.pcapng import packets
from cobotwire_codegen.facts import ASPECTS
from cobotwire_codegen.language.evidence import VERDICTS
from cobotwire_codegen.language.names import LOWER, wrong_name
from cobotwire_codegen.legal import visible

MOST_FILE = 20 * 2**20
MOST_JSON = 2 * 2**20
MOST_RECORDING = 50 * 2**20
# Ten minutes of traffic at 115,200 baud have less.
MOST_LINE = 8 * 2**20
MOST_REPORT = 16 * 2**20
MOST_FACTS = 20_000
MOST_FRAMES = 8
MOST_BYTES = 1000
# The members of a survey, and the size that each may have.
MEMBERS = {"survey.json": MOST_JSON, "recording.pcapng": MOST_RECORDING}
# The facts of a command that the verdict on a test case decides; * stands for every field.
CASES = {
    "query-replied": ("command/present", "command/deadline"),
    "change-replied": ("command/present", "command/deadline"),
    "reply-frame": ("reply/id", "reply/length"),
    "reply-fields": ("reply.*/range",),
    "agrees": ("command/agreement",),
    "effect": ("command/effect",),
    "read-back": ("command/effect",),
    "arrives": ("command/effect",),
}
_FACT = re.compile(
    r"[a-z]\w{0,79}/(command|request|reply|(request|reply)\.[a-z*]\w{0,79})/"
    rf"({'|'.join(ASPECTS)})",
    re.ASCII,
)
# The names of USB ports and of built-in ports. At any other port, the arm may be simulated.
_DEVICE = re.compile(
    r"/dev/(tty(USB|ACM|AMA|THS)\d+|cu\.[\w#-]+|serial/by-(id|path)/[^/]+)|COM\d+", re.ASCII | re.I
)
# The name of the robot in reports, and in surveys that do not name it.
_UNNAMED = "an arm"
_SEAL = ("digest", "signature")
_CHANGED = "the file was changed after it was written: its digest does not match"
_DAY = re.compile(r"(20\d\d-(0[1-9]|1[0-2])-(0[1-9]|[12]\d|3[01]))(T[\d:.+\-Z]{0,30})?", re.ASCII)
_HEX = re.compile(rf"([0-9A-Fa-f]{{2}} ?){{0,{MOST_BYTES}}}")


class NotEvidence(Exception):
    """The file is not a survey or report that can be used; the message says why."""


@dataclass(frozen=True, slots=True)
class Reported:
    """A fact as a file states it: COMMAND/PART/ASPECT; the frames as pairs, sent and received."""

    fact: str
    confirmed: bool
    why: str
    frames: tuple[tuple[bytes, bytes], ...]


@dataclass(slots=True)
class Submitted:
    """What a file states. ``line`` has the bytes of its recording; None if it has no recording."""

    kind: str
    edition: str
    robot: str
    firmware: str
    day: str
    digest: str
    table: str
    facts: list[Reported] = field(default_factory=list)
    line: bytes | None = None


def read_submitted(path: Path) -> Submitted:
    """Return what a file states.

    Raises:
        NotEvidence: the file is not a survey or report, or exceeds a limit.
        OSError: the file cannot be read.
    """
    with path.open("rb") as file:
        data = file.read(MOST_FILE + 1)
    _require(len(data) <= MOST_FILE, f"the file has more than {MOST_FILE >> 20} MB, the limit")
    return submitted(data)


def submitted(data: bytes) -> Submitted:
    """Return what the bytes of a file state.

    Raises:
        NotEvidence: they are not a survey or report, or exceed a limit.
    """
    digest = sha256(data).hexdigest()
    if data.startswith(b"PK"):
        members = _members(data)
        document, recording = _parsed(members["survey.json"]), members["recording.pcapng"]
        _check_digest(document, sha256(recording).hexdigest())
        found = _survey(document, digest)
        found.line = _line(recording)
        return found
    _require(
        len(data) <= MOST_REPORT, f"the report has more than {MOST_REPORT >> 20} MB, the limit"
    )
    document = _parsed(data)
    _check_digest(document)
    return _report(document, digest)


def _check_digest(document: dict[str, Any], recording: str = "") -> None:
    """Check the digest that a document states, as ``cobotwire.inspect.seal`` defines it.

    The files of the first surveys state none. ``conform verify`` checks who signed a file.
    """
    if "digest" not in document:
        return
    _require(document.get("recording_digest", "") == recording, _CHANGED)
    contents = {key: value for key, value in document.items() if key not in _SEAL}
    text = json.dumps(contents, sort_keys=True, separators=(",", ":"))
    _require(sha256(text.encode()).hexdigest() == document["digest"], _CHANGED)


def _require(holds: bool, message: str) -> None:
    if not holds:
        raise NotEvidence(visible(message))


def _members(data: bytes) -> dict[str, bytes]:
    """Return the two members of a survey.

    The sizes that a zip file states may be false, so reading is limited.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            names = [info.filename for info in archive.infolist()]
            shown = ", ".join(names[:5])[:200]
            _require(
                sorted(names) == sorted(MEMBERS),
                f"a survey has the members {' and '.join(MEMBERS)}; this file has: {shown}",
            )
            return {name: _member(archive, name, most) for name, most in MEMBERS.items()}
    except (
        *(zipfile.BadZipFile, zlib.error, struct.error, NotImplementedError, RuntimeError),
        *(EOFError, OSError, ValueError, LookupError),
    ) as error:
        raise NotEvidence(visible(f"the file is not a whole zip file: {error}"[:200])) from error


def _member(archive: zipfile.ZipFile, name: str, most: int) -> bytes:
    usual = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
    _require(archive.getinfo(name).compress_type in usual, f"{name} has an unusual compression")
    with archive.open(name) as file:
        content = file.read(most + 1)
    _require(len(content) <= most, f"{name} has more than {most >> 20} MB, the limit")
    return content


def _parsed(data: bytes) -> dict[str, Any]:
    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        _require(len({key for key, _ in pairs}) == len(pairs), "the JSON has a key twice")
        return dict(pairs)

    try:
        found = json.loads(data.decode(), object_pairs_hook=once)
    except (ValueError, RecursionError) as error:
        raise NotEvidence(visible(f"this is not JSON: {error}"[:200])) from error
    record: dict[str, Any] = _of(found, dict, "the file")
    return record


def _of(value: Any, kind: type, name: str) -> Any:
    """Return a JSON value; reject one of another kind, and a list that is too long."""
    _require(type(value) is kind, f"{name} must be a {kind.__name__}")
    _require(kind is not list or len(value) <= MOST_FACTS, f"{name} is too long")
    return value


def _text(record: dict[str, Any], key: str, most: int = 80, least: int = 1) -> str:
    """Return a text of one line.

    Reject texts with control characters, and texts that are too long.
    """
    text = " ".join(_of(record.get(key), str, key).split())
    _require(least <= len(text) <= most, f"{key} must have {least} to {most} characters")
    _require(text.isprintable(), f"{key} has characters that cannot be printed")
    return text


def _edition(record: dict[str, Any]) -> str:
    name = _text(record, "edition")
    _require(not wrong_name(name, LOWER), f"edition is {name!r}, which is not a name")
    return name


def _day(text: str) -> str:
    match = _DAY.fullmatch(text)
    _require(match is not None, f"the date is {text!r}; write it like 2026-11-24")
    return match[1] if match else ""


def _bytes(value: Any) -> bytes:
    """Return the bytes of a frame; empty if there are too many, or the text was shortened."""
    text = _of(value, str, "a frame")
    return bytes.fromhex(text) if _HEX.fullmatch(text) else b""


def _survey(data: dict[str, Any], digest: str) -> Submitted:
    head = (data.get("format"), data.get("version"))
    _require(head == ("cobotwire-survey", 1), "the file is not a survey of version 1")
    _require(
        data.get("simulated") is False,
        "nothing in the survey shows that the arm is real; if it is, and the port cannot show it, "
        "run `cobotwire survey --real-arm`",
    )
    edition = _edition(data)
    versions = _of(data.get("firmware"), dict, "firmware")
    _require(len(versions) <= 8, "firmware has more than 8 entries")
    return Submitted(
        "survey",
        edition,
        _text(data, "robot", least=0) or _UNNAMED,
        ", ".join(f"{_text({'query': key}, 'query')} {_text(versions, key)}" for key in versions),
        _day(_text(data, "date")),
        digest,
        _text(data, "edition_digest", least=0),
        [*_facts(_of(data.get("facts"), list, "facts"), edition)],
    )


def _facts(listed: list[Any], edition: str) -> Iterator[Reported]:
    seen: set[str] = set()
    for each in listed:
        record = _of(each, dict, "a fact")
        name, verdict = _text(record, "fact", 260), _text(record, "verdict")
        fact = name.removeprefix(f"{edition}/")
        _require(fact != name, f"the fact {name} is not about {edition}")
        _require(bool(_FACT.fullmatch(fact)), f"{name} is not the name of a fact")
        _require(name not in seen, f"the fact {name} is given twice")
        seen.add(name)
        _require(verdict in (*VERDICTS, "not seen"), f"the verdict of {name} is {verdict!r}")
        pairs = [
            (_bytes(pair.get("sent", "")), _bytes(pair.get("received", "")))
            for frame in _of(record.get("frames", []), list, "frames")[:MOST_FRAMES]
            for pair in [_of(frame, dict, "a pair of frames")]
        ]
        if verdict in VERDICTS:
            why = _text(record, "why", 400, 0)
            yield Reported(fact, verdict == "confirmed", why, tuple(pairs))


def _report(data: dict[str, Any], digest: str) -> Submitted:
    head = (data.get("format"), data.get("version"), data.get("kind"))
    _require(
        head == ("cobotwire-conformance", 4, "device"),
        "the file is not a survey, nor a report of `cobotwire conform device --json`",
    )
    subject = _text(data, "subject", 200)
    options = _of(data.get("options"), dict, "options")
    simulated = "simulated" in subject or "command" in options
    _require(not simulated, "the report is about a program, which proves nothing about a robot")
    _require(
        bool(_DEVICE.fullmatch(subject)),
        f"there may be a program at {subject}, so the report proves nothing about a robot; send "
        "the file of `cobotwire survey --real-arm` instead",
    )
    facts: dict[str, Reported] = {}
    for each in _of(data.get("results"), list, "results"):
        for reported in _of_case(_of(each, dict, "a result")):
            # A failed test case overrides passed ones about the same fact.
            before = facts.get(reported.fact)
            if before is None or before.confirmed:
                facts[reported.fact] = reported
    return Submitted(
        "conformance test",
        _edition(data),
        # The port and host of the run stay out of the spec.
        _UNNAMED,
        _text(data, "firmware", least=0),
        _day(_text(data, "started")),
        digest,
        _text(data, "edition_digest", least=0),
        [*facts.values()],
    )


def _of_case(result: dict[str, Any]) -> Iterator[Reported]:
    verdict, command = _text(result, "verdict"), _text(result, "command", least=0)
    if verdict not in ("pass", "fail"):
        return
    frames, sent = [], b""
    for each in _of(result.get("evidence"), list, "evidence")[: 2 * MOST_FRAMES]:
        exchange = _of(each, dict, "an exchange")
        if exchange.get("direction") == "sent":
            sent = _bytes(exchange.get("data"))
        else:
            frames.append((sent, _bytes(exchange.get("data"))))
    for fact in CASES.get(_text(result, "case"), ()):
        name = f"{command}/{fact}"
        if _FACT.fullmatch(name):
            why = "" if verdict == "pass" else _text(result, "reason", 2000)[:400]
            yield Reported(name, verdict == "pass", why, tuple(frames))


def _line(recording: bytes) -> bytes:
    """Return the bytes of the packets of a pcapng file, one after another.

    Raises:
        NotEvidence: it is not a pcapng file, or is damaged.
    """
    try:
        line = b"".join(packet.data for packet in packets(recording))
    except ValueError as error:
        raise NotEvidence(str(error)) from error
    _require(len(line) <= MOST_LINE, f"the recording has more than {MOST_LINE >> 20} MB of traffic")
    return line
