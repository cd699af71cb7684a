"""Count findings, and describe many of them in one sentence."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from cobotwire.diagnose.findings import (
    SUMMARIZED,
    Boot,
    CommandError,
    Finding,
    Nuls,
    Panic,
    Unrecognised,
)


class Summary:
    """Counts findings and describes them in one sentence; keeps the first of each kind."""

    def __init__(self, findings: Iterable[Finding] = ()) -> None:
        self.kinds: Counter[str] = Counter()
        self.bytes: Counter[str] = Counter()
        self._first: dict[str, Finding] = {}
        self._reboots = 0
        for finding in findings:
            self.add(finding)

    def add(self, finding: Finding) -> None:
        """Count a finding; continuations count with their first piece."""
        kind = finding.kind
        self.bytes[kind] += len(finding.data)
        if finding.continued:
            return
        self.kinds[kind] += 1
        self._first.setdefault(kind, finding)
        self._reboots += isinstance(finding, Nuls) and finding.reboot

    def __str__(self) -> str:
        """Return the sentence, most important findings first; empty if there are none."""
        parts = [self._reboot(), self._command_errors()]
        parts += [self._several(kind) for kind in SUMMARIZED]
        parts += [self._nuls(), self._unrecognised()]
        return "; ".join(part for part in parts if part)

    def _reboot(self) -> str:
        panics, boots = self.kinds[Panic.kind], self.kinds[Boot.kind]
        panic, boot = self._first.get(Panic.kind), self._first.get(Boot.kind)
        cause = panic.cause_text() if isinstance(panic, Panic) else ""
        if isinstance(panic, Panic) and not (self._reboots or boots or panic.rebooting):
            return f"the controller failed: {cause}"
        most = max(panics, boots, self._reboots)
        if not most:
            return ""
        reason = cause or (boot.cause if isinstance(boot, Boot) else "")
        times = "" if most == 1 else f" {most} times"
        return f"the controller rebooted{times}" + (f": {reason}" if reason else "")

    def _command_errors(self) -> str:
        count = self.kinds[CommandError.kind]
        times = "" if count == 1 else f" {count} times"
        return f"the firmware reported cmd_len error{times}" if count else ""

    def _several(self, kind: type[Finding]) -> str:
        count, noun = self.kinds[kind.kind], kind.summary_noun
        if not count:
            return ""
        example = self._first[kind.kind].example()
        if count == 1:
            return f"{kind.summary_prefix}{example}"
        plural = f"{noun}{'es' if noun.endswith('h') else 's'}"
        return f"{kind.summary_prefix}{count} {plural}, e.g. {example}"

    def _nuls(self) -> str:
        short = self.kinds[Nuls.kind] - self._reboots
        return "" if short <= 0 else f"{short} short run{'s' * (short != 1)} of NULs"

    def _unrecognised(self) -> str:
        count = self.bytes[Unrecognised.kind]
        return "" if not count else f"{count} unrecognised byte{'s' * (count != 1)}"


def summarize(findings: Iterable[Finding]) -> str:
    """Describe findings in a sentence: ``the controller rebooted: panic LoadProhibited``."""
    return str(Summary(findings))
