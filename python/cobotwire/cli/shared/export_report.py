"""Format the report of an export, for people."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cobotwire.capture.export import Report
from cobotwire.protocol.counted import counted
from cobotwire.protocol.printable import printable

# How many notes, messages and files are listed.
LISTED = 20


def report_lines(report: Report) -> Iterator[str]:
    """Yield what was read, what was left out or could not be read, and what was written."""
    yield from map(printable, report.notes[:LISTED])
    if (more := len(report.notes) - LISTED) > 0:
        yield f"and {counted(more, 'other note')}; --json lists each"
    taken = f"{counted(report.inputs, 'input')}, {counted(report.bytes, 'byte')}"
    rows, files = counted(report.rows.total(), "row"), counted(len(report.files), "file")
    yield f"{taken}: {rows} in {files}"
    yield from (f"  {count:>10} x {label}" for label, count in report.rows.most_common(LISTED))
    if (more := len(report.rows) - LISTED) > 0:
        yield f"             and {counted(more, 'other message')}; --json counts each"
    yield from _by_reason("byte", report.noise, " of noise")
    if report.rejected:
        frames = counted(report.rejected, "frame")
        yield f"{frames} rejected: values that the edition does not allow"
    if report.not_chosen:
        yield f"{counted(report.not_chosen, 'message')} left out: other commands or directions"
    if report.outside:
        yield f"{counted(report.outside, 'message')} left out: outside of the time range"
    yield from _by_reason("pause", report.gaps)
    yield from map(printable, report.unread)
    yield from (f"incomplete: {printable(text)}" for text in report.truncated)
    if not report.files:
        yield "no file was written" + ": no message was chosen" * bool(report.frames)
    yield from (
        f"wrote {printable(file.path)}: {counted(file.bytes, 'byte')}"
        for file in report.files[:LISTED]
    )
    if further := report.files[LISTED:]:
        size = counted(sum(file.bytes for file in further), "byte")
        yield f"wrote {counted(len(further), 'other file')}: {size}; --json lists each"


def _by_reason(noun: str, counts: Mapping[str, int], of: str = "") -> Iterator[str]:
    if total := sum(counts.values()):
        yield f"{counted(total, noun)}{of}: " + ", ".join(
            f"{n} {reason}" for reason, n in counts.items()
        )
