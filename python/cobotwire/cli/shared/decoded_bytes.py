"""Decode bytes that have no times and one direction, and print them."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.capture.byte_source import ByteSource
from cobotwire.cli.shared.item_formats import line_texts
from cobotwire.cli.shared.stream_printer import DecodeOptions, StreamPrinter, write_text
from cobotwire.codec.interface import Codec
from cobotwire.diagnose import Diagnoser, Item
from cobotwire.diagnose.counts import StreamCounts
from cobotwire.diagnose.survey import StreamSurvey

# Printing the frames of this many bytes takes some seconds, so a progress bar is shown.
LONG_FILE = 4 << 20


def decode_bytes(source: ByteSource, options: DecodeOptions, counts: StreamCounts) -> None:
    """Decode bytes that have no times and one direction."""
    codec = codecs.load(editions.load(options.edition).TABLE)
    counted_only = options.as_json or options.quiet
    if counted_only and not source.from_arguments and StreamSurvey.reads(codec):
        _survey_bytes(codec, source, options, counts)
    else:
        diagnose_bytes(codec, source, options, counts)


def _survey_bytes(
    codec: Codec, source: ByteSource, options: DecodeOptions, counts: StreamCounts
) -> None:
    """Decode bytes, as :func:`diagnose_bytes` does, without an object for each frame."""
    texts = None if options.quiet else line_texts(codec.table, options.file)
    survey = StreamSurvey(
        codec, options.direction, accept_unknown=options.accept_unknown, texts=texts
    )
    printer = StreamPrinter(codec, options.direction, options, StreamCounts())

    def report(items: list[Item]) -> None:
        counts.add_findings(items)
        if not options.quiet:
            write_text("".join(map(printer.line, items)))

    try:
        with _progress(source, options.quiet) as blocks:
            for block in blocks:
                report(survey.feed(block))
            report(survey.flush())
    finally:
        counts.add_survey(survey)


def diagnose_bytes(
    codec: Codec, source: ByteSource, options: DecodeOptions, counts: StreamCounts
) -> None:
    """Decode bytes frame by frame."""
    framer = codec.framer(options.direction, accept_unknown=options.accept_unknown)
    counts.framers.append(framer)
    if source.from_arguments:
        options = options._replace(each_byte=True)
    printer = StreamPrinter(codec, options.direction, options, counts)
    diagnoser = Diagnoser(codec, options.direction)
    with _progress(source, options.quiet) as blocks:
        for block in blocks:
            printer.print(diagnoser.feed(framer.feed(block)))
        printer.print(diagnoser.feed(framer.flush()) + diagnoser.flush())


@contextmanager
def _progress(source: ByteSource, quiet: bool) -> Iterator[Iterator[bytes]]:
    """Yield the blocks of the source; show a bar for a long file if the terminal is not in use."""
    free = quiet or not sys.stdout.isatty()
    long = source.size is not None and source.size >= LONG_FILE
    if not (long and free and sys.stderr.isatty()):
        yield (block for block, _ in source.blocks)
        return
    # Imported here, because rich takes longer to import than most input takes to decode.
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True)) as bar:
        task = bar.add_task("decoding", total=source.size)

        def blocks() -> Iterator[bytes]:
            for block, taken in source.blocks:
                yield block
                bar.advance(task, taken)

        yield blocks()
