"""``cobotwire capture info``: show what recordings hold."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Sequence
from typing import Any

import click

from cobotwire.capture.overview import Overview, StreamOverview, overview
from cobotwire.capture.packet_parsing import UNDATED, UNTIMED
from cobotwire.cli.shared.capture_files import recorded_size, time_text
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.output import print_line
from cobotwire.cli.shared.progress_bar import progress_bar
from cobotwire.inspect.captured import recorded_codecs
from cobotwire.protocol.counted import counted
from cobotwire.protocol.printable import printable

DAMAGED = 6


@click.command()
@click.argument("files", nargs=-1, required=True, type=click.Path(), metavar="FILE...")
@click.option(
    "--gap",
    type=click.FloatRange(min=0),
    default=1.0,
    show_default=True,
    metavar="SECONDS",
    help="Count pauses longer than this.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
@uses_edition
def info(edition: str, files: tuple[str, ...], gap: float, as_json: bool) -> None:
    """Show what each FILE holds, and the totals if there are several.

    A rate is measured from the first to the last message of its kind. Noise is bytes that belong to
    no frame. A gap is a pause in which no byte came on an interface. An interface is read with the
    edition that it names; otherwise with that of --edition.

    \b
      cobotwire capture info arm.pcapng
      cobotwire capture info *.pcapng --gap 0.2 --json

    Exit codes: 0 every FILE is whole; 1 one is truncated or unfinished; 6 one is damaged, or is not
    a recording.
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    with progress_bar("reading", recorded_size(files)) as advance:
        codecs, gap_ns = recorded_codecs(edition), round(gap * 1e9)
        found = [overview(file, codecs, gap_ns, advance) for file in files]
    if as_json:
        print_line(json.dumps({"files": [*map(_object, found)], "total": _total(found)}))
    else:
        for each in found:
            print_line("\n".join(_lines(each, gap)))
        if len(found) > 1:
            print_line("\n".join(_total_lines(_total(found))))
    missing = any(each.missing for each in found)
    sys.exit(DAMAGED if any(each.error for each in found) else int(missing))


def _lines(found: Overview, gap: float) -> Iterator[str]:
    yield printable(found.name)
    program = printable(found.application) or "a program without a name"
    sections = f"{counted(found.sections, 'section')}, by {program}" if found.sections else ""
    yield "  " + ", ".join(filter(None, (counted(found.size, "byte"), found.format or sections)))
    yield f"  {printable(str(found.error or found.missing or 'whole: nothing is missing'))}"
    start_ns = found.times.first_ns if found.times else 0
    if found.times and not found.application.endswith(UNTIMED):
        undated = found.application.endswith(UNDATED)
        for label, time_ns in (("start", start_ns), ("end", found.times.last_ns)):
            time = f"{time_ns / 1e9:.6f} s (no date)" if undated else time_text(time_ns)
            yield f"  {label:9} {time}"
        yield f"  duration  {_seconds(found.times.last_ns - start_ns)}"
    for number in range(len(found.interfaces)):
        yield from _interface_lines(found, number)
    if found.rejected:
        yield f"  {counted(found.rejected, 'frame')} with values that the edition does not allow"
    if found.gap_count:
        most = "; the longest:" if found.gap_count > len(found.gaps) else ":"
        sums = counted(found.gap_count, "gap"), _seconds(found.gap_ns)
        yield f"  {sums[0]} longer than {gap:g} s, {sums[1]} together{most}"
    for pause in found.gaps:
        lengths = _seconds(pause.begin_ns - start_ns), _seconds(pause.length_ns)
        yield f"    at {lengths[0]:>16} for {lengths[1]:>14}, interface {pause.interface}"


def _interface_lines(found: Overview, number: int) -> Iterator[str]:
    interface = found.interfaces[number]
    yield f"  interface {number}: {printable(interface.url) or 'a port without a name'}"
    edition = f"edition {printable(interface.edition)}" if interface.edition else "no edition"
    yield f"    {edition}" + (f", {interface.baudrate} bit/s" if interface.baudrate else "")
    for stream in found.streams:
        if stream.interface == number:
            yield from _stream_lines(stream)
    messages = [(label, times) for (at, label), times in found.messages.items() if at == number]
    for label, times in sorted(messages, key=lambda item: -item[1].number):
        rate = "" if times.rate is None else f"{times.rate:10.3f} per s"
        yield f"    {times.number:>10} x {label:42}{rate}".rstrip()


def _stream_lines(stream: StreamOverview) -> Iterator[str]:
    sums = f"{counted(stream.frames, 'frame')}, {counted(stream.bytes, 'byte')}"
    yield f"    {stream.direction:9} {sums}"
    for reason, size in stream.noise.items():
        share = f"{100 * size / stream.bytes:.2f} %"
        yield f"              {counted(size, 'byte')} of noise, {share}: {reason}"


def _seconds(time_ns: int) -> str:
    return f"{time_ns / 1e9:.3f} s"


def _object(found: Overview) -> dict[str, Any]:
    messages = [
        {"interface": interface, "message": label, "rate": times.rate, **times._asdict()}
        for (interface, label), times in found.messages.items()
    ]
    names = "interfaces", "streams", "gaps"
    lists = {name: [each._asdict() for each in getattr(found, name)] for name in names}
    times = found.times and found.times._asdict()
    error = found.error and str(found.error)
    return {**vars(found), **lists, "messages": messages, "times": times, "error": error}


def _total(found: Sequence[Overview]) -> dict[str, int]:
    streams = [stream for each in found for stream in each.streams]
    return {
        "files": len(found),
        "not_whole": sum(bool(each.error or each.missing) for each in found),
        "size": sum(each.size for each in found),
        "frames": sum(stream.frames for stream in streams),
        "noise": sum(sum(stream.noise.values()) for stream in streams),
        "gap_count": sum(each.gap_count for each in found),
    }


def _total_lines(total: dict[str, int]) -> Iterator[str]:
    yield f"{counted(total['files'], 'file')}, {total['not_whole']} of them not whole"
    nouns = {"size": "byte", "frames": "frame", "noise": "byte", "gap_count": "gap"}
    size, frames, noise, gaps = (counted(total[name], noun) for name, noun in nouns.items())
    yield f"  {size}, {frames}, {noise} of noise, {gaps}"
