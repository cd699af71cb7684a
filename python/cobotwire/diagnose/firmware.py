"""Recognise text and panics of the controller's firmware.

The panic handler's texts are ESP-IDF's (its "Fatal Errors" page): ``Guru Meditation Error: Core 1
panic'ed (LoadProhibited)``, registers, ``Backtrace:`` with pairs of a program and a stack address,
``Rebooting...``. Older versions print ``of type LoadProhibited occurred on core 1``.
"""

from __future__ import annotations

import re

from cobotwire.diagnose.findings import Boot, CommandError, Finding, Panic, Text
from cobotwire.diagnose.residue import Residue, Verdict, Wait

# Bytes of text; ESC starts a colour of ESP-IDF's log.
READABLE = rb"\t\n\r\x1b -~"
# This many readable bytes in a row are text; in random bytes one place in 300 starts as many.
TEXT_MINIMUM = 6
# Longer lines are cut. Dumps have about 2.4 kB, so they are hardly ever cut.
LINE_LIMIT = 1024
PANIC_LIMIT = 8192

COMMAND_ERROR = b"cmd_len error"
PANIC = b"Guru Meditation Error"
REBOOTING = b"Rebooting..."

_RUN = re.compile(rb"[" + READABLE + rb"]+")
_LINE = re.compile(rb"[\r\n]*[^\r\n]*")
_LINE_END = re.compile(rb"\r?\n|\r")
# Up to four damaged bytes do not end a dump, if readable ones follow.
_DAMAGED = rb"[^" + READABLE + rb"]{1,4}(?=[" + READABLE + rb"]{6})"
_DUMP = re.compile(rb"(?:[" + READABLE + rb"]+|" + _DAMAGED + rb")*")
_DAMAGED_LOOKAHEAD = 4 + TEXT_MINIMUM

_CAUSE = re.compile(r"Core\s+(\d+) panic'ed \(([^)]*)\)|of type (.*?) occurred on core\s+(\d+)")
_PC = re.compile(r"\bPC\s*:\s*0x([0-9a-fA-F]{8})")
_ADDRESS = re.compile(r"\bEXCVADDR\s*:\s*0x([0-9a-fA-F]{8})")
_BACKTRACE = re.compile(r"Backtrace:((?:\s*0x[0-9a-fA-F]{8}:0x[0-9a-fA-F]{8})*)")
_RESET = re.compile(r"\brst:0x[0-9a-fA-F]+ \((\w+)\)")


def recognise(residue: Residue, at: int, in_text: bool) -> Verdict:
    """Recognise the line at ``at``; after other text (``in_text``) it may be short.

    A line may be interrupted by a frame.
    """
    data = residue.data
    run = _RUN.match(data, at, at + LINE_LIMIT + len(PANIC))
    if run is None:
        return None
    size = run.end() - at
    may_grow = run.end() == len(data) and not residue.closed
    if size < TEXT_MINIMUM and not in_text:
        return Wait.WAIT if may_grow else None
    line = _LINE.match(data, at, run.end())
    assert line is not None, "the pattern matches anything"
    text = line.group().lstrip(b"\r\n")
    start = line.end() - len(text)
    if text.startswith(PANIC):
        return _panic(residue, at, start)
    if text.startswith(COMMAND_ERROR):
        return _command_error(residue, at, start + len(COMMAND_ERROR))
    return _line(residue, at, line.end(), may_grow)


def _line(residue: Residue, at: int, end: int, may_grow: bool) -> Verdict:
    """Return an ordinary line, up to its end or to the start of a special message in it."""
    data = residue.data
    ends_text = end == len(data) or not _RUN.match(data, end, end + 1)
    marks = [data.find(word, at + 1, end) for word in (PANIC, COMMAND_ERROR)]
    marked = min((mark for mark in marks if mark >= 0), default=-1)
    if marked >= 0:
        return _text(residue, at, min(marked, at + LINE_LIMIT))
    if end - at >= LINE_LIMIT + len(PANIC) or (end - at >= LINE_LIMIT and not may_grow):
        return _text(residue, at, at + LINE_LIMIT)
    if ends_text:
        return Wait.WAIT if may_grow else _text(residue, at, end)
    closing = _line_end(residue, end)
    return closing if isinstance(closing, Wait) else _text(residue, at, closing)


def _line_end(residue: Residue, at: int) -> int | Wait:
    """Return the place after the line end at ``at``, if there is one before the next frame."""
    limit, final = residue.stretch(at)
    found = _LINE_END.match(residue.data, at, limit)
    end = found.end() if found else at
    undecided = end == limit and residue.data[at:end] in (b"", b"\r")
    return Wait.WAIT if undecided and not final else end


def _text(residue: Residue, start: int, end: int) -> Finding:
    text = residue.data[start:end].decode("ascii")
    spans, reason = residue.spans(start, end), residue.reason(start)
    reset = _RESET.search(text)
    if reset:
        return Boot(spans=spans, reason=reason, cause=reset.group(1))
    return Text(spans=spans, reason=reason, text=text)


def _command_error(residue: Residue, at: int, end: int) -> Verdict:
    limit, final = residue.stretch(end - 1)
    if limit == end:
        closing: int | Wait = end if final else Wait.WAIT
    else:
        closing = _line_end(residue, end)
    if isinstance(closing, Wait):
        return closing
    return CommandError(spans=residue.spans(at, closing), reason=residue.reason(at))


def _panic(residue: Residue, at: int, start: int) -> Verdict:
    """Return the dump up to ``Rebooting...``, the next panic, the end of the text or the limit."""
    data = residue.data
    dump = _DUMP.match(data, start, at + PANIC_LIMIT + _DAMAGED_LOOKAHEAD)
    assert dump is not None, "the pattern matches anything"
    end = min(dump.end(), at + PANIC_LIMIT)
    again = data.find(PANIC, start + len(PANIC), end)
    end = again if again >= 0 else end
    rebooting = data.find(REBOOTING, start, end)
    if rebooting >= 0:
        closing = _line_end(residue, rebooting + len(REBOOTING))
        return closing if isinstance(closing, Wait) else _dump(residue, at, closing)
    undecided = len(data) - end < _DAMAGED_LOOKAHEAD and end - at < PANIC_LIMIT and again < 0
    return Wait.WAIT if undecided and not residue.closed else _dump(residue, at, end)


def _dump(residue: Residue, start: int, end: int) -> Panic:
    text = residue.data[start:end].decode("latin-1")
    found = _CAUSE.search(text)
    modern, cause, older_cause, older = found.groups() if found else (None, None, None, None)
    core = modern or older
    backtrace = _BACKTRACE.search(text)
    pairs = backtrace.group(1).split() if backtrace else []
    return Panic(
        spans=residue.spans(start, end),
        reason=residue.reason(start),
        core=None if core is None else int(core),
        cause=cause or older_cause,
        pc=_hex(_PC, text),
        address=_hex(_ADDRESS, text),
        backtrace=tuple(int(pair.partition(":")[0], 16) for pair in pairs),
        rebooting="Rebooting..." in text,
    )


def _hex(pattern: re.Pattern[str], text: str) -> int | None:
    found = pattern.search(text)
    return int(found.group(1), 16) if found else None
