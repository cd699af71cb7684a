"""Decode bytes of one direction, without timestamps, and print them."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from typing import TYPE_CHECKING

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.capture.byte_source import ByteSource
from cobotwire.cli.shared.item_formats import line_texts
from cobotwire.cli.shared.stream_printer import DecodeOptions, StreamPrinter, write_text
from cobotwire.codec.interface import Codec, Event, Noise
from cobotwire.diagnose.counts import StreamCounts

if TYPE_CHECKING:
    from cobotwire.diagnose import Item
    from cobotwire.diagnose.stream_summary import StreamSummary

# Printing the frames of this many bytes takes some seconds, so a progress bar is shown.
LONG_FILE = 4 << 20


def decode_bytes(source: ByteSource, options: DecodeOptions, counts: StreamCounts) -> None:
    """Decode bytes of one direction, without timestamps."""
    codec = _codec(options.edition, codecs.chosen())
    summary = None if source.from_arguments else _summary_of(codec, options)
    if summary is None:
        diagnose_bytes(codec, source, options, counts)
    else:
        _summarize_bytes(summary, codec, source, options, counts)


@lru_cache
def _codec(edition: str, name: codecs.CodecName) -> Codec:
    """Return the codec that all files share: making its tables takes longer than reading a file."""
    return codecs.load(editions.load(edition).TABLE, name)


def _summary_of(codec: Codec, options: DecodeOptions) -> StreamSummary | None:
    """Return a summary; None if the options or the codec need an object for each frame."""
    if not options.as_json and not options.quiet:
        return None
    from cobotwire.diagnose.stream_summary import StreamSummary

    if not StreamSummary.reads(codec):
        return None
    texts = None if options.quiet else line_texts(codec.table, options.file)
    return StreamSummary(
        codec, options.direction, accept_unknown=options.accept_unknown, texts=texts
    )


def _summarize_bytes(
    summary: StreamSummary,
    codec: Codec,
    source: ByteSource,
    options: DecodeOptions,
    counts: StreamCounts,
) -> None:
    """Decode bytes, as :func:`diagnose_bytes` does, without an object for each frame."""
    from cobotwire.diagnose.stream_summary import Lines

    printer = StreamPrinter(codec, options.direction, options, StreamCounts())

    def line(item: Item) -> str:
        return item.text if isinstance(item, Lines) else printer.format(item) + "\n"

    def report(items: list[Item]) -> None:
        counts.add_findings(items)
        if not options.quiet:
            write_text("".join(map(line, items)))

    try:
        with _progress(source, options.quiet) as blocks:
            for block in blocks:
                report(summary.feed(block))
            report(summary.flush())
    finally:
        counts.add_summary(summary)


def diagnose_bytes(
    codec: Codec, source: ByteSource, options: DecodeOptions, counts: StreamCounts
) -> None:
    """Decode bytes frame by frame."""
    framer = codec.framer(options.direction, accept_unknown=options.accept_unknown)
    counts.framers.append(framer)
    if source.from_arguments:
        options = options._replace(each_byte=True)
    printer = StreamPrinter(codec, options.direction, options, counts)
    with _progress(source, options.quiet) as blocks:

        def events() -> Iterator[list[Event]]:
            yield from map(framer.feed, blocks)
            yield framer.flush()

        for items in _diagnosed(codec, options, events()):
            printer.print(items)


def _diagnosed(
    codec: Codec, options: DecodeOptions, blocks: Iterable[list[Event]]
) -> Iterator[Sequence[Item]]:
    """Yield the items of the stream; import the diagnosis when the first noise comes."""
    rest = iter(blocks)
    for events in rest:
        frames = [event for event in events if not isinstance(event, Noise)]
        if len(frames) == len(events):
            yield frames
            continue
        from cobotwire.diagnose import Diagnoser

        diagnoser = Diagnoser(codec, options.direction)
        yield diagnoser.feed(events)
        for more in rest:
            yield diagnoser.feed(more)
        yield diagnoser.flush()


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
