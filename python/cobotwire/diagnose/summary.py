"""Count findings, and describe many of them in one sentence."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from cobotwire.diagnose.findings import Finding
from cobotwire.diagnose.registry import CLASSES


class Summary:
    """Counts findings and describes them in one sentence; keeps the first of each kind."""

    def __init__(self, findings: Iterable[Finding] = ()) -> None:
        self.kinds: Counter[str] = Counter()
        self.bytes: Counter[str] = Counter()
        self._first: dict[str, Finding] = {}
        # The signs that the controller failed, by kind: their number and the first cause.
        self._failures: Counter[str] = Counter()
        self._causes: dict[str, str] = {}
        self._rebooted = False
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
        failure = finding.failure
        if failure is not None:
            self._failures[kind] += 1
            self._causes.setdefault(kind, failure)
            self._rebooted |= finding.reboots

    def add_more(self, kind: str, count: int, size: int) -> None:
        """Count further findings of a kind, of ``size`` bytes together; none of them is a failure.

        The first finding of each kind must be added with :meth:`add`.
        """
        self.kinds[kind] += count
        self.bytes[kind] += size

    def __str__(self) -> str:
        """Return the sentence, most important findings first; empty if there are none."""
        parts = [self._failed()] if self._failures else []
        for kind in (each.kind for each in CLASSES):
            count = self.kinds[kind] - self._failures[kind]
            if count:
                parts.append(self._first[kind].summarize(count, self.bytes[kind]))
        return "; ".join(parts)

    def _failed(self) -> str:
        # One failure may leave several signs: a panic, a boot message and NULs.
        most = max(self._failures.values())
        times = "" if most == 1 else f" {most} times"
        cause = next((self._causes[c.kind] for c in CLASSES if self._causes.get(c.kind)), "")
        verb = "rebooted" if self._rebooted else "failed"
        if self._failures.keys() == {"nuls"}:
            verb = f"possibly {verb}"
        return f"the controller {verb}{times}" + (f": {cause}" if cause else "")


def summarize(findings: Iterable[Finding]) -> str:
    """Describe findings in a sentence: ``the controller rebooted: panic LoadProhibited``."""
    return str(Summary(findings))
