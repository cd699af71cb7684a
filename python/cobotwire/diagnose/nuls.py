"""Recognise runs of NULs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from cobotwire.codec.interface import NoiseReason
from cobotwire.diagnose.findings import CHECK_CONTROLLER, Finding, Span
from cobotwire.diagnose.recogniser import Recogniser
from cobotwire.diagnose.residue import Residue, Verdict, Wait

# This many NULs in a row are a finding, also inside other noise.
NUL_MINIMUM = 4
NUL_LIMIT = 4096
# This many NULs in a row may mean a reboot. About 277 were seen when an arm restarted; other
# traffic has fewer: a frame has at most 16 data bytes, a sync write to six servos 50.
REBOOT_NULS = 64


@dataclass(frozen=True, slots=True, kw_only=True)
class Nuls(Finding):
    """NUL bytes in a row; from ``REBOOT_NULS`` on the controller possibly restarts."""

    count: int
    reboot: bool
    kind: ClassVar[str] = "nuls"
    advice: ClassVar[str] = CHECK_CONTROLLER
    piece: ClassVar[int | None] = NUL_LIMIT

    @property
    def failure(self) -> str | None:
        """Return "" if the controller may have restarted: NULs do not state a reason."""
        return "" if self.reboot else None

    @property
    def ordinary(self) -> bool:
        """Return True for a few NULs: they are not a restart."""
        return not self.reboot

    def describe(self) -> str:
        """Describe the run."""
        return f"{self.count} NULs" + (": the controller possibly restarts" if self.reboot else "")

    def summarize(self, count: int, size: int) -> str:
        """Describe short runs."""
        return f"{count} short run{'s' * (count != 1)} of NULs"


class NulRuns(Recogniser):
    """Recognises runs of NULs, in pieces of ``NUL_LIMIT``."""

    starts = rb"\0{%d}|\0+\Z" % NUL_MINIMUM

    def recognise(self, residue: Residue, at: int) -> Verdict:
        """Recognise the run at ``at``."""
        limit, final = residue.segment_end(at)
        rest = residue.data[at : min(limit, at + NUL_LIMIT)]
        count = len(rest) - len(rest.lstrip(b"\0"))
        if at + count == limit and count < NUL_LIMIT and not final:
            return Wait.WAIT
        if count < NUL_MINIMUM:
            return None
        return nuls(residue.spans(at, at + count), residue.reason(at))


def nuls(spans: tuple[Span, ...], reason: NoiseReason) -> Nuls:
    """Return a run of NULs of any length."""
    count = sum(len(span.data) for span in spans)
    return Nuls(spans=spans, reason=reason, count=count, reboot=count >= REBOOT_NULS)
