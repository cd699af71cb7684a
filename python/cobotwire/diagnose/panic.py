"""Recognise panic dumps of the controller's firmware.

The texts are those of ESP-IDF's panic handler (its "Fatal Errors" page): ``Guru Meditation Error:
Core 1 panic'ed (LoadProhibited)``, registers, ``Backtrace:`` with pairs of a program and a stack
address, ``Rebooting...``. Older versions print ``of type LoadProhibited occurred on core 1``.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import ClassVar

from cobotwire.diagnose.findings import CHECK_CONTROLLER, Finding
from cobotwire.diagnose.residue import Residue, Verdict, Wait
from cobotwire.protocol.printable import printable

# Bytes of text; ESC starts a colour of ESP-IDF's log.
READABLE = rb"\t\n\r\x1b -~"
# Dumps have about 2.4 kB, so they are hardly ever cut.
PANIC_LIMIT = 8192
PANIC = b"Guru Meditation Error"
REBOOTING = b"Rebooting..."
# An ESP32 has two cores. A longer number is damaged, and may be too long for int().
CORE_DIGITS = 2

# Up to four damaged bytes do not end a dump, if six readable ones follow.
_DAMAGED = rb"[^" + READABLE + rb"]{1,4}(?=[" + READABLE + rb"]{6})"
_DUMP = re.compile(rb"(?:[" + READABLE + rb"]+|" + _DAMAGED + rb")*")
_DAMAGED_LOOKAHEAD = 4 + 6

_CAUSE = re.compile(r"Core\s+(\d+) panic'ed \(([^)]*)\)|of type (.*?) occurred on core\s+(\d+)")
_PC = re.compile(r"\bPC\s*:\s*0x([0-9a-fA-F]{8})")
_ADDRESS = re.compile(r"\bEXCVADDR\s*:\s*0x([0-9a-fA-F]{8})")
_BACKTRACE = re.compile(r"Backtrace:((?:\s*0x[0-9a-fA-F]{8}:0x[0-9a-fA-F]{8})*)")


@dataclass(frozen=True, slots=True, kw_only=True)
class Panic(Finding):
    """An ESP32 panic dump; what it does not contain is None."""

    core: int | None
    cause: str | None
    pc: int | None
    address: int | None
    backtrace: tuple[int, ...]
    rebooting: bool
    kind: ClassVar[str] = "panic"
    advice: ClassVar[str] = CHECK_CONTROLLER
    readable: ClassVar[bool] = True

    @property
    def failure(self) -> str | None:
        """Return the panic with its cause."""
        return f"panic {printable(self.cause or 'of unknown cause')}"

    @property
    def reboots(self) -> bool:
        """Return whether the controller reboots."""
        return self.rebooting

    def describe(self) -> str:
        """Describe the panic."""
        text = self.failure or ""
        if self.core is not None:
            text += f" on core {self.core}"
        if self.pc is not None:
            text += f" at 0x{self.pc:08x}"
        if self.backtrace:
            text += f", backtrace of {len(self.backtrace)}"
        return text + (", rebooting" if self.rebooting else "")


def recognise_panic(residue: Residue, at: int, start: int) -> Verdict:
    """Recognise the dump at ``start``.

    The bytes from ``at`` to ``start`` are line ends and belong to the dump. It ends after
    ``Rebooting...``, before the next panic, at the end of the text or at the limit.
    """
    data = residue.data
    dump = _DUMP.match(data, start, at + PANIC_LIMIT + _DAMAGED_LOOKAHEAD)
    assert dump is not None, "the pattern matches anything"
    end = min(dump.end(), at + PANIC_LIMIT)
    again = data.find(PANIC, start + len(PANIC), end)
    end = again if again >= 0 else end
    rebooting = data.find(REBOOTING, start, end)
    if rebooting >= 0:
        closing = residue.line_end(rebooting + len(REBOOTING))
        return closing if isinstance(closing, Wait) else _panic(residue, at, closing)
    undecided = len(data) - end < _DAMAGED_LOOKAHEAD and end - at < PANIC_LIMIT and again < 0
    return Wait.WAIT if undecided and not residue.closed else _panic(residue, at, end)


def _panic(residue: Residue, start: int, end: int) -> Panic:
    text = residue.data[start:end].decode("latin-1")
    found = _CAUSE.search(text)
    modern, cause, older_cause, older = found.groups() if found else (None, None, None, None)
    core = modern or older
    backtrace = _BACKTRACE.search(text)
    pairs = backtrace.group(1).split() if backtrace else []
    return Panic(
        spans=residue.spans(start, end),
        reason=residue.reason(start),
        core=None if core is None or len(core) > CORE_DIGITS else int(core),
        cause=cause or older_cause,
        pc=_hex(_PC, text),
        address=_hex(_ADDRESS, text),
        backtrace=tuple(int(pair.partition(":")[0], 16) for pair in pairs),
        rebooting=REBOOTING.decode() in text,
    )


def _hex(pattern: re.Pattern[str], text: str) -> int | None:
    found = pattern.search(text)
    return int(found.group(1), 16) if found else None
