"""Recognise text of the controller's firmware: lines, error messages, boot messages, panics."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import ClassVar

from cobotwire.diagnose.findings import CHECK_CONTROLLER, SHOWN, Finding
from cobotwire.diagnose.panic import PANIC, READABLE, recognise_panic
from cobotwire.diagnose.recogniser import Recogniser
from cobotwire.diagnose.residue import Residue, Verdict, Wait

# This many readable bytes in a row are text; random bytes have such a run at one place in 300.
TEXT_MINIMUM = 6
# Longer lines are cut.
LINE_LIMIT = 1024
COMMAND_ERROR = b"cmd_len error"

_RUN = re.compile(rb"[" + READABLE + rb"]+")
_LINE = re.compile(rb"[\r\n]*[^\r\n]*")
_RESET = re.compile(r"\brst:0x[0-9a-fA-F]+ \((\w+)\)")


@dataclass(frozen=True, slots=True, kw_only=True)
class Text(Finding):
    """A line of readable text, with its line end if it has one."""

    text: str
    kind: ClassVar[str] = "text"
    advice: ClassVar[str] = "the firmware prints messages; cobotwire skips them"
    serious: ClassVar[bool] = False
    piece: ClassVar[int | None] = LINE_LIMIT
    readable: ClassVar[bool] = True
    summary_prefix: ClassVar[str] = "text: "
    summary_noun: ClassVar[str] = "line"

    @property
    def ordinary(self) -> bool:
        """Return True: firmware that works prints such lines."""
        return True

    def describe(self) -> str:
        """Describe the text."""
        return f"text: {self.example()}"

    def example(self) -> str:
        """Return the text in quotes, with escaped control characters, cut if it is long."""
        text = self.text.strip("\r\n")
        return repr(text if len(text) <= SHOWN else text[: SHOWN - 3] + "...")


@dataclass(frozen=True, slots=True, kw_only=True)
class CommandError(Finding):
    """The firmware's ``cmd_len error``: it received a damaged request, or two at once."""

    kind: ClassVar[str] = "cmd-len-error"
    advice: ClassVar[str] = (
        "the arm receives damaged requests: check whether another program writes to this port "
        "(lsof PORT), whether the cable is too long, and whether the hub has power"
    )
    readable: ClassVar[bool] = True

    @property
    def ordinary(self) -> bool:
        """Return True: the arm continues to work."""
        return True

    def describe(self) -> str:
        """Describe the error."""
        return "the firmware reports cmd_len error: it received a damaged request, or two at once"

    def summarize(self, count: int, size: int) -> str:
        """Describe how often the firmware reported it."""
        times = "" if count == 1 else f" {count} times"
        return f"the firmware reported cmd_len error{times}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Boot(Finding):
    """The boot loader's line with the cause of the boot, such as ``SW_CPU_RESET``."""

    cause: str
    kind: ClassVar[str] = "boot"
    advice: ClassVar[str] = CHECK_CONTROLLER
    readable: ClassVar[bool] = True

    @property
    def failure(self) -> str | None:
        """Return the cause of the boot."""
        return self.cause

    def describe(self) -> str:
        """Describe the boot."""
        return f"the controller boots: {self.cause}"


class Firmware(Recogniser):
    """Recognises text line by line; a frame may interrupt a line."""

    starts = rb"[%s]{%d}|[%s]+\Z" % (READABLE, TEXT_MINIMUM, READABLE)

    def recognise(self, residue: Residue, at: int) -> Verdict:
        """Recognise the line at ``at``; directly after other text it may be short."""
        data = residue.data
        run = _RUN.match(data, at, at + LINE_LIMIT + len(PANIC))
        if run is None:
            return None
        may_grow = run.end() == len(data) and not residue.closed
        if run.end() - at < TEXT_MINIMUM and not residue.after_text:
            return Wait.WAIT if may_grow else None
        line = _LINE.match(data, at, run.end())
        assert line is not None, "the pattern matches anything"
        text = line.group().lstrip(b"\r\n")
        start = line.end() - len(text)
        if text.startswith(PANIC):
            return recognise_panic(residue, at, start)
        if text.startswith(COMMAND_ERROR):
            return _command_error(residue, at, start + len(COMMAND_ERROR))
        return _line(residue, at, line.end(), may_grow)


def starts_message(data: bytes) -> bool | None:
    """Return whether ``data`` starts with an error message; None if more bytes are needed."""
    messages = (PANIC, COMMAND_ERROR)
    if data.startswith(messages):
        return True
    return None if any(message.startswith(data) for message in messages) else False


def _line(residue: Residue, at: int, end: int, may_grow: bool) -> Verdict:
    """Return an ordinary line, up to its end or to the start of an error message in it."""
    data = residue.data
    ends_text = end == len(data) or not _RUN.match(data, end, end + 1)
    marks = [data.find(word, at + 1, end) for word in (PANIC, COMMAND_ERROR)]
    marked = min((mark for mark in marks if mark >= 0), default=-1)
    if marked >= 0:
        return _text(residue, at, min(marked, at + LINE_LIMIT))
    # A line that ends is complete, whatever follows it.
    may_grow = may_grow and ends_text
    if end - at >= LINE_LIMIT + len(PANIC) or (end - at >= LINE_LIMIT and not may_grow):
        return _text(residue, at, at + LINE_LIMIT)
    if ends_text:
        return Wait.WAIT if may_grow else _text(residue, at, end)
    closing = residue.line_end(end)
    return closing if isinstance(closing, Wait) else _text(residue, at, closing)


def _text(residue: Residue, start: int, end: int) -> Finding:
    text = residue.data[start:end].decode("ascii")
    spans, reason = residue.spans(start, end), residue.reason(start)
    reset = _RESET.search(text)
    if reset:
        return Boot(spans=spans, reason=reason, cause=reset.group(1))
    return Text(spans=spans, reason=reason, text=text)


def _command_error(residue: Residue, at: int, end: int) -> Verdict:
    limit, final = residue.segment_end(end - 1)
    if limit == end:
        closing: int | Wait = end if final else Wait.WAIT
    else:
        closing = residue.line_end(end)
    if isinstance(closing, Wait):
        return closing
    return CommandError(spans=residue.spans(at, closing), reason=residue.reason(at))
