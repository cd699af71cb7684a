"""The file of a survey: a zip of ``survey.json`` and ``recording.pcapng``."""

from __future__ import annotations

import io
import json
import platform
import zipfile
from collections.abc import Mapping
from datetime import datetime
from hashlib import sha256
from pathlib import Path
from typing import Any

import cobotwire
from cobotwire.capture.file_errors import unusable_file
from cobotwire.conformance.provenance import edition_digest
from cobotwire.conformance.survey.survey import Survey
from cobotwire.inspect.seal import Signer, check_seal, sealed
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.printable import printable

FORMAT, VERSION = "cobotwire-survey", 1
JSON, RECORDING = "survey.json", "recording.pcapng"
# The most bytes of the file and of its members.
MOST_FILE, MOST = 20 << 20, {JSON: 2 << 20, RECORDING: 50 << 20}
MOST_NAME = 80
# The texts of a fact.
FACT = ("fact", "verdict", "why")


def content_of(
    survey: Survey, package: str, robot: str, *, simulated: bool, began: datetime
) -> dict[str, Any]:
    """Return what the file states: no name of a host, user, port or folder."""
    return {
        "format": FORMAT,
        "version": VERSION,
        "edition": survey.table.edition,
        "edition_digest": edition_digest(package),
        "address": survey.address,
        "robot": printable(robot)[:MOST_NAME],
        "simulated": simulated,
        "firmware": survey.firmware,
        "date": began.strftime("%Y-%m-%dT%H:%M:%SZ"),
        "cobotwire": cobotwire.__version__,
        "codec": cobotwire.codec_in_use(),
        "level": survey.level,
        "left_out": survey.left_out,
        "host": {"system": platform.system(), "python": platform.python_version()},
        "hashed": survey.hashed,
        "finished": survey.finished,
        "facts": [fact.as_json() for fact in survey.facts.values()],
    }


def continued(
    earlier: tuple[Mapping[str, Any], bytes], content: dict[str, Any], recording: bytes
) -> tuple[dict[str, Any], bytes]:
    """Return the content and the recording of a survey that continues an earlier one.

    The recordings are concatenated: a pcapng file may have several sections.
    """
    old, recorded = earlier
    decided = {f["fact"]: f for f in old["facts"] if f["verdict"] != "not seen"}
    for fact in content["facts"]:
        if (
            fact["verdict"] != "not seen"
            and decided.get(fact["fact"], fact)["verdict"] != "contradicted"
        ):
            decided[fact["fact"]] = fact
    # Some facts are in the content only if they were observed, such as a late acknowledgement.
    merged = [decided.pop(fact["fact"], fact) for fact in content["facts"]] + [*decided.values()]
    hashed = list(dict.fromkeys([*old.get("hashed", ()), *content["hashed"]]))
    level = max(old.get("level", 1), content["level"])
    simulated = old.get("simulated") is not False or content["simulated"]
    changed = {"facts": merged, "hashed": hashed, "level": level, "simulated": simulated}
    return content | changed, recorded + recording


def survey_file(
    content: Mapping[str, object], recording: bytes, sign: Signer | None = None
) -> bytes:
    """Return the file of a survey, sealed; ``recording`` is a pcapng file."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        document = sealed(_with_recording(content, recording), sign)
        archive.writestr(JSON, json.dumps(document, indent=1))
        archive.writestr(RECORDING, recording)
    return file.getvalue()


def _with_recording(content: Mapping[str, Any], recording: bytes) -> dict[str, Any]:
    return {**content, "recording_digest": sha256(recording).hexdigest()}


def read_survey(path: str | Path) -> tuple[dict[str, Any], bytes]:
    """Return the content and the recording of a survey's file.

    Raises:
        UsageError: the file cannot be read, is not the file of a survey, or was changed. A survey
            without a digest is read as it is.
    """
    content, recording = unsealed(path)
    if "digest" in content and not check_seal(content).intact:
        message = f"{printable(str(path))} was changed after it was written (`conform verify`)"
        raise UsageError("survey", str(path), message=message)
    return content, recording


def unsealed(path: str | Path) -> tuple[dict[str, Any], bytes]:
    """Return the content and the recording of a survey's file; the seal is not checked.

    The content states the digest of the recording that is in the file.

    Raises:
        UsageError: the file cannot be read, or is not the file of a survey.
    """
    try:
        with open(path, "rb") as file:
            data = file.read(MOST_FILE + 1)
    except (OSError, ValueError) as error:
        raise unusable_file("survey", path, error) from None
    try:
        if len(data) > MOST_FILE:
            raise ValueError(f"it has more than {MOST_FILE} bytes")
        text, recording = _members(data)
        content = json.loads(text)
        _check(content)
    # Damaged archives raise errors of many kinds, among them those of the decompressors.
    except Exception as error:
        message = f"{printable(str(path))} is not the file of a survey: {printable(str(error))}"
        raise UsageError("survey", str(path), message=message) from None
    return _with_recording(content, recording) if "digest" in content else content, recording


def _members(data: bytes) -> list[bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        if sorted(archive.namelist()) != sorted(MOST):
            raise ValueError(f"its members are not {' and '.join(MOST)}")
        found = []
        for name, most in MOST.items():
            with archive.open(name) as member:
                found.append(member.read(most + 1))
            if len(found[-1]) > most:
                raise ValueError(f"{name} has more than {most} bytes")
        return found


def _check(content: Any) -> None:
    """Check what a continued survey uses of the file; ``cobotwire-gen`` checks all of it."""
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise ValueError(f"{JSON} does not have the format {FORMAT!r}")
    facts = content.get("facts")
    for key in ("left_out", "hashed"):
        texts = content.get(key, [])
        if not isinstance(texts, list) or not all(
            isinstance(each, str) and each.isprintable() for each in texts
        ):
            raise ValueError(f"{key} is not a list of texts")
    if content.get("level", 1) not in (1, 2, 3):
        raise ValueError("level is not 1, 2 or 3")
    if content.get("version") != VERSION or not isinstance(facts, list):
        raise ValueError(f"{JSON} is not of version {VERSION}, or lists no facts")
    for fact in facts:
        if not all(isinstance(fact[k], str) and fact[k].isprintable() for k in FACT):
            raise ValueError("a fact has no name, verdict or reason")
        for frame in fact["frames"]:
            bytes.fromhex(frame["sent"] + frame["received"])
