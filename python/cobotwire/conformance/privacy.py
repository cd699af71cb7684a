"""Remove from a report the paths and serial numbers of the tester's machine.

A path inside the working folder becomes relative; of other paths only the last part remains. Serial
numbers become hashes, so that two of them still differ. Ports (``/dev/ttyUSB0``) stay.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import fields, is_dataclass, replace
from hashlib import sha256
from pathlib import Path
from typing import Any

from cobotwire.conformance.report import Exchange, Report

# Hashes are cut to this many characters.
SHOWN = 16
PART = r"[^\s/\\:;,'\"`<>|(){}\[\]]+"
PATHS = re.compile(
    rf"(?<![\w./:~\\-])/(?!dev/)(?:{PART}/)+({PART})?|(?<![\w\\])[A-Za-z]:\\(?:{PART}\\)*({PART})?"
)
# Names that udev and macOS make from the serial number of an adapter.
SERIAL = re.compile(r"(?<=/by-id/)(?!#)[^\s'\"]+|(?<=\busbserial-)\w+")


def hashed(text: str) -> str:
    """Return a hash of a text, which does not show it; an empty text has none."""
    return text and f"#{sha256(text.encode(errors='replace')).hexdigest()[:SHOWN]}"


def without_paths(text: str) -> str:
    """Return a text without absolute paths and serial numbers."""
    if "/" not in text and "\\" not in text:
        return text
    for folder, name in ((Path.cwd(), ""), (Path.home(), "~/")):
        if len(folder.parts) > 1:
            text = text.replace(f"{folder}/", name).replace(f"{folder}\\", name)
    text = SERIAL.sub(lambda found: hashed(found[0]), text)
    return PATHS.sub(lambda found: found[1] or found[2] or "", text)


def anonymous(report: Report) -> Report:
    """Return a report without absolute paths and serial numbers."""

    def cleaned(value: Any) -> Any:
        if isinstance(value, Exchange):
            # The evidence of a codec is text, which can hold paths. Other evidence is the bytes of
            # frames, which stay as they are.
            data = value.data if report.kind != "codec" else _bytes(value.data)
            return value._replace(data=data, note=without_paths(value.note))
        return _cleaned(value, cleaned)

    found: Report = _cleaned(report, cleaned)
    return found


def _bytes(data: bytes) -> bytes:
    return without_paths(data.decode("latin-1")).encode("latin-1")


def _cleaned(value: Any, cleaned: Callable[[Any], Any]) -> Any:
    """Return a value with each text in it replaced."""
    if type(value) is str:
        return without_paths(value)
    if is_dataclass(value) and not isinstance(value, type):
        return replace(value, **{f.name: cleaned(getattr(value, f.name)) for f in fields(value)})
    if isinstance(value, list | tuple):
        return type(value)(map(cleaned, value))
    if isinstance(value, dict):
        return {name: cleaned(each) for name, each in value.items()}
    return value
