"""Format the report of an export, for people."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cobotwire.capture.export import Report
from cobotwire.protocol.printable import printable

# Messages and files that are listed by name.
LISTED = 20


def report_lines(report: Report) -> Iterator[str]:
    """Yield what was read, what was written, and what could not be."""
    inputs, files = _count(report.inputs, "input"), _count(len(report.files), "file")
    yield f"{inputs}, {report.bytes} bytes: {_count(report.rows.total(), 'row')} in {files}"
    yield from (f"  {count:>10} x {label}" for label, count in report.rows.most_common(LISTED))
    if (more := len(report.rows) - LISTED) > 0:
        yield f"             and {_count(more, 'other message')}; --json counts each"
    yield from _by_reason("bytes of noise", report.noise)
    if report.rejected:
        yield f"{report.rejected} frames rejected: they have values that the edition does not allow"
    if report.not_chosen:
        yield f"{report.not_chosen} messages left out: other commands or directions"
    if report.outside:
        yield f"{report.outside} messages left out: outside of the time range"
    yield from _by_reason("pause" if report.gaps.total() == 1 else "pauses", report.gaps)
    yield from (f"incomplete: {printable(text)}" for text in report.truncated)
    yield from (
        f"wrote {printable(file.path)}: {file.bytes} bytes" for file in report.files[:LISTED]
    )
    if further := report.files[LISTED:]:
        size = sum(file.bytes for file in further)
        yield f"wrote {_count(len(further), 'other file')}: {size} bytes; --json lists each"


def _by_reason(what: str, counts: Mapping[str, int]) -> Iterator[str]:
    if total := sum(counts.values()):
        yield f"{total} {what}: " + ", ".join(f"{n} {reason}" for reason, n in counts.items())


def _count(number: int, what: str) -> str:
    return f"{number} {what}" if number == 1 else f"{number} {what}s"
