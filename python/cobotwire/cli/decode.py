"""``cobotwire decode``: explain bytes, byte streams and recordings."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

import click
from rich.console import Console
from rich.progress import Progress

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.capture import CaptureReader
from cobotwire.capture.byte_source import ByteFormat, ByteSource, open_bytes
from cobotwire.capture.streams import DirectionStream
from cobotwire.cli.shared.exit_codes import OUTPUT_CLOSED
from cobotwire.cli.shared.hex_colours import frame_colours
from cobotwire.cli.shared.input_files import input_files
from cobotwire.cli.shared.item_formats import Format, as_object, byte_by_byte, line_texts, one_line
from cobotwire.cli.shared.output import discard_output
from cobotwire.cli.shared.recordings import ARROWS, recording_named, warn_if_incomplete
from cobotwire.codec.interface import Codec, Listening
from cobotwire.diagnose import Diagnoser, Item
from cobotwire.diagnose.counts import StreamCounts
from cobotwire.diagnose.explain import DIRECTIONS, FrameReader
from cobotwire.diagnose.survey import Lines, StreamSurvey
from cobotwire.inspect.captured import diagnose_capture
from cobotwire.protocol.printable import printable

# Decoding this many bytes takes some seconds, so a progress bar is shown.
LONG_FILE = 4 << 20


class Options(NamedTuple):
    """What to print, and how."""

    edition: str
    direction: Listening
    accept_unknown: bool
    each_byte: bool
    as_json: bool
    quiet: bool
    # The name of the file, if there are several.
    file: str | None = None


@click.command(short_help="Explain bytes, streams and recordings.")
@click.argument("input", nargs=-1, required=True, type=click.Path(), metavar="HEX...|FILE...|-")
@click.option("--raw", "format", flag_value="raw", help="FILE holds raw bytes.")
@click.option("--hex", "format", flag_value="hex", help="FILE holds hex text.")
@click.option(
    "--direction",
    type=click.Choice(["request", "reply", "both"]),
    default="both",
    show_default=True,
    help="Which messages the bytes hold.",
)
@click.option(
    "--accept-unknown", is_flag=True, help="Accept frames with ids unknown to the edition."
)
@click.option("--bytes", "each_byte", is_flag=True, help="Explain each byte, as is done for HEX.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object per line.")
@click.option("--summary", is_flag=True, help="Print only counts.")
@click.option("--quiet", is_flag=True, help="Print nothing but the summary, if any.")
@click.pass_obj
def decode(
    edition: str,
    input: tuple[str, ...],
    format: ByteFormat | None,
    direction: Listening,
    accept_unknown: bool,
    each_byte: bool,
    as_json: bool,
    summary: bool,
    quiet: bool,
) -> None:
    """Print the meaning of each frame, and the diagnosis of everything else.

    HEX is bytes as pairs of hex digits, with or without spaces, commas or 0x. Anything else is a
    FILE, a folder of files, or a pattern such as '*.bin'; - is standard input. The --summary of
    several files counts all of them. If an argument is both hex and an existing file, write ./NAME
    for the file or 0xNAME for the bytes.

    A recording (pcapng, which other verbs write with --record) is decoded packet by packet. Each
    frame is decoded in the direction in which it was sent, and printed with its time. --direction
    applies only to packets of unknown direction.

    Any other FILE holds raw bytes or hex text. It is hex text if its first 512 bytes contain only
    hex. Other text is rejected, so that it is not decoded by mistake. --raw and --hex choose the
    format.

    \b
      cobotwire decode FE FE 06 21 01 00 1D 14 FA
      cobotwire decode capture.bin --summary
      cobotwire decode monday.bin tuesday.bin captures/ '*.hex' --summary
      cobotwire decode arm.pcapng
      cat capture.hex | cobotwire decode - --hex --json

    Exit codes: 0 all bytes are legal frames; 1 some are not; 141 the reader of the output closed
    it.
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    quiet = quiet or summary
    options = Options(edition, direction, accept_unknown, each_byte, as_json, quiet)
    files = input_files(input)
    counts = StreamCounts()
    try:
        for names in [input] if files is None else [(name,) for name in files]:
            if files is not None and len(files) > 1:
                options = _name_file(options, names[0])
            capture = recording_named(names) if format is None else None
            if capture is None:
                _decode_bytes(open_bytes(names, format, _notify), options, counts)
            else:
                _decode_recording(capture, options, counts)
    finally:
        # Ctrl-C prints the counts up to that point.
        if summary:
            _print(_counts_json(counts) if as_json else "\n".join(_counts_lines(counts)))
    sys.exit(0 if counts.only_legal else 1)


def _name_file(options: Options, name: str) -> Options:
    """Print the heading of one of several files; return the options to decode it."""
    if not options.quiet and not options.as_json:
        _print(f"{printable(name)}:")
    return options._replace(file=name)


def _notify(text: str) -> None:
    click.echo(f"cobotwire: {text}", err=True)


class _StreamPrinter:
    """Counts the items of one stream, and prints them."""

    def __init__(
        self, codec: Codec, listening: Listening, options: Options, counts: StreamCounts
    ) -> None:
        directions = tuple(d for d in DIRECTIONS if listening in (d, "both"))
        self.reader = FrameReader(codec, directions)
        self._counts, self._options = counts, options
        self._file = {} if options.file is None else {"file": options.file}
        self._format = self._choose_format(codec)

    def _choose_format(self, codec: Codec) -> Format:
        if self._options.as_json:
            return lambda item: json.dumps({**self._file, **as_object(self.reader, item)})
        colour = sys.stdout.isatty() and not os.environ.get("NO_COLOR")
        paint = frame_colours(codec.table.frame) if colour else None
        if self._options.each_byte:
            return byte_by_byte(self.reader, codec.table, paint)
        return one_line(self.reader, paint)

    def print(self, items: list[Item]) -> None:
        self._counts.add(items, self.reader)
        if items and not self._options.quiet:
            _print("\n".join(map(self.format, items)))

    def format(self, item: Item) -> str:
        return self._format(item)

    def line(self, item: Item) -> str:
        return item.text if isinstance(item, Lines) else self.format(item) + "\n"


class _TimedStreamPrinter(_StreamPrinter):
    """Prints the time and direction of each item of a recorded stream."""

    def __init__(
        self,
        stream: DirectionStream,
        capture: CaptureReader,
        start_ns: int,
        options: Options,
        counts: StreamCounts,
    ) -> None:
        super().__init__(stream.codec, stream.listening, options, counts)
        counts.framers.append(stream.framer)
        self._stream, self._start_ns = stream, start_ns
        self._url = capture.interfaces[stream.interface].url
        several = len(capture.interfaces) > 1
        self._label = f" interface {stream.interface}" if several else ""

    def format(self, item: Item) -> str:
        time_ns = self._stream.time_of(item.offset)
        after = (time_ns - self._start_ns) / 1e9
        direction = self._stream.direction
        if not self._options.as_json:
            return f"{after:10.6f}{self._label} {ARROWS[direction]} {super().format(item)}"
        when = {"time_ns": time_ns, "after": after, "url": self._url, "direction": direction}
        return json.dumps({**self._file, **when, **as_object(self.reader, item)})


def _decode_bytes(source: ByteSource, options: Options, counts: StreamCounts) -> None:
    """Decode bytes that have no times and one direction."""
    codec = codecs.load(editions.load(options.edition).TABLE)
    counted_only = options.as_json or options.quiet
    if counted_only and not source.from_arguments and StreamSurvey.reads(codec):
        _survey_bytes(codec, source, options, counts)
    else:
        _diagnose_bytes(codec, source, options, counts)


def _survey_bytes(codec: Codec, source: ByteSource, options: Options, counts: StreamCounts) -> None:
    """Decode bytes, as :func:`_diagnose_bytes` does, without an object for each frame."""
    texts = None if options.quiet else line_texts(codec.table, options.file)
    survey = StreamSurvey(
        codec, options.direction, accept_unknown=options.accept_unknown, texts=texts
    )
    printer = _StreamPrinter(codec, options.direction, options, StreamCounts())

    def report(items: list[Item]) -> None:
        counts.add_findings(items)
        if not options.quiet:
            _write("".join(map(printer.line, items)))

    try:
        with _progress(source, options.quiet) as blocks:
            for block in blocks:
                report(survey.feed(block))
            report(survey.flush())
    finally:
        counts.add_survey(survey)


def _diagnose_bytes(
    codec: Codec, source: ByteSource, options: Options, counts: StreamCounts
) -> None:
    """Decode bytes frame by frame."""
    framer = codec.framer(options.direction, accept_unknown=options.accept_unknown)
    counts.framers.append(framer)
    if source.from_arguments:
        options = options._replace(each_byte=True)
    printer = _StreamPrinter(codec, options.direction, options, counts)
    diagnoser = Diagnoser(codec, options.direction)
    with _progress(source, options.quiet) as blocks:
        for block in blocks:
            printer.print(diagnoser.feed(framer.feed(block)))
        printer.print(diagnoser.feed(framer.flush()) + diagnoser.flush())


def _decode_recording(capture: CaptureReader, options: Options, counts: StreamCounts) -> None:
    """Decode each direction of each interface on its own, with times."""
    printers: dict[DirectionStream, _TimedStreamPrinter] = {}
    start_ns: int | None = None
    with capture:
        for stream, items in diagnose_capture(
            capture, options.edition, options.direction, accept_unknown=options.accept_unknown
        ):
            if start_ns is None:
                start_ns = stream.start_ns
            if stream not in printers:
                printers[stream] = _TimedStreamPrinter(stream, capture, start_ns, options, counts)
            printers[stream].print(items)
        warn_if_incomplete(capture)


def _counts_lines(counts: StreamCounts) -> Iterator[str]:
    noise, kinds = counts.noise, counts.findings.kinds
    yield f"{counts.bytes} bytes, {counts.frames.total()} frames, {counts.resyncs} resyncs"
    yield from (f"  {count:>10} x {name}" for name, count in counts.frames.most_common())
    yield f"{noise.total()} bytes of noise"
    yield from (f"  {count:>10} {reason}" for reason, count in noise.most_common())
    yield f"{kinds.total()} findings"
    yield from (f"  {count:>10} x {kind}" for kind, count in kinds.most_common())
    if diagnosis := str(counts.findings):
        yield f"diagnosis: {diagnosis}"


def _counts_json(counts: StreamCounts) -> str:
    return json.dumps({"kind": "summary", **counts.as_dict()})


def _print(text: str) -> None:
    _write(text + "\n")


def _write(text: str) -> None:
    try:
        sys.stdout.write(text)
        # After each block, so that live input is shown as it comes.
        sys.stdout.flush()
    except BrokenPipeError:
        discard_output()
        sys.exit(OUTPUT_CLOSED)


@contextmanager
def _progress(source: ByteSource, quiet: bool) -> Iterator[Iterator[bytes]]:
    """Yield the blocks of the source; show a bar for a long file if the terminal is not in use."""
    free = quiet or not sys.stdout.isatty()
    long = source.size is not None and source.size >= LONG_FILE
    console = Console(stderr=True)
    with Progress(console=console, disable=not (long and free and console.is_terminal)) as bar:
        task = bar.add_task("decoding", total=source.size)

        def blocks() -> Iterator[bytes]:
            for block, taken in source.blocks:
                yield block
                bar.advance(task, taken)

        yield blocks()
