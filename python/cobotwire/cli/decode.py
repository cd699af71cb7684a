"""``cobotwire decode``: what each byte is."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Literal

import click
from rich.console import Console
from rich.progress import Progress

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.capture import CaptureReader
from cobotwire.cli.recorded import capture_in, tell_the_end
from cobotwire.cli.source import Form, Source, open_source
from cobotwire.cli.strand import Look, Strand, Strands
from cobotwire.cli.tally import Tally
from cobotwire.codec.interface import Framer
from cobotwire.diagnose import Item

# A bar is worth its place where a file takes some seconds.
LONG_FILE = 4 << 20
# What a shell says of a process that SIGPIPE ended.
READER_GONE = 141


@click.command()
@click.argument("words", nargs=-1, required=True, metavar="HEX...|FILE|-")
@click.option("--raw", "form", flag_value="raw", help="The one word is a FILE of raw bytes.")
@click.option("--hex", "form", flag_value="hex", help="The one word is a FILE of hex text.")
@click.option(
    "--direction",
    type=click.Choice(["request", "reply", "both"]),
    default="both",
    show_default=True,
    help="Which way the bytes went.",
)
@click.option("--accept-unknown", is_flag=True, help="Also take ids that the edition lacks.")
@click.option("--bytes", "each_byte", is_flag=True, help="Explain each byte, as for HEX words.")
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object a line.")
@click.option("--summary", is_flag=True, help="Print counts at the end.")
@click.option("--quiet", is_flag=True, help="Print no events, only what else is asked for.")
@click.pass_obj
def decode(
    edition: str,
    words: tuple[str, ...],
    form: Form | None,
    direction: Literal["request", "reply", "both"],
    accept_unknown: bool,
    each_byte: bool,
    as_json: bool,
    summary: bool,
    quiet: bool,
) -> None:
    """Explain bytes: frames with what they say, noise with what it is.

    Words that are HEX (pairs of digits, with or without blanks, commas or 0x) are the bytes. Any
    other single word is a FILE, and - is the standard input. A word that is hex and the name of a
    file is refused: say ./NAME or 0xNAME.

    A FILE that is a recording (pcapng, see --record) is read packet by packet: each frame has its
    time, and is read in the direction in which it went; --direction is for packets that tell none.

    Any other FILE or - holds raw bytes or hex text. It is hex if its first 512 bytes are nothing
    but hex; other plain text is refused, so that it is not taken for raw bytes by mistake. --raw
    and --hex say it without guessing.

    \b
      cobotwire decode FE FE 06 21 01 00 1D 14 FA
      cobotwire decode capture.bin --summary
      cobotwire decode arm.pcapng
      cat capture.hex | cobotwire decode - --hex --json

    Exit code 1 if there is anything among the bytes that is no legal frame; 141 if whoever read
    the output went away.
    """  # noqa: D301  (\b is the control character by which click keeps the lines)
    look = Look(edition, direction, accept_unknown, each_byte, as_json, _colour())
    capture = capture_in(words) if form is None else None
    framers: list[Framer] = []
    tally = Tally(framers)
    try:
        if capture is None:
            _bytes(open_source(words, form), look, framers, tally, quiet)
        else:
            _packets(capture, look, framers, tally, quiet)
    finally:
        # Also what was counted until Ctrl-C.
        if summary:
            _write(tally.as_json() if as_json else tally.lines())
    sys.exit(0 if tally.clean else 1)


def _bytes(source: Source, look: Look, framers: list[Framer], tally: Tally, quiet: bool) -> None:
    """Bytes that have no times, and all one direction."""
    codec = codecs.load(editions.load(look.edition).TABLE)
    strand = Strand(codec, look.direction, look._replace(each_byte=look.each_byte or source.words))
    framers.append(strand.framer)

    def take(items: list[Item]) -> None:
        tally.count(items, strand.read)
        if items and not quiet:
            _write("\n".join(map(strand.show, items)))

    with _progress(source, quiet) as blocks:
        for block in blocks:
            take(strand.feed(block))
        take(strand.flush())


def _packets(
    capture: CaptureReader, look: Look, framers: list[Framer], tally: Tally, quiet: bool
) -> None:
    """A recording: each direction on its own, with its times."""
    strands = Strands(capture, look)
    with capture:
        for strand, items, start in strands.items():
            framers[:] = [known.framer for known in strands.all.values()]
            tally.count(items, strand.read)
            if items and not quiet:
                _write("\n".join(strand.shown(item, start) for item in items))
        tell_the_end(capture)


def _write(text: str) -> None:
    try:
        sys.stdout.write(text + "\n")
        # A block at a time, so that a live line is seen as it comes.
        sys.stdout.flush()
    except BrokenPipeError:
        # Replaced, so that the flush at exit does not fail once more.
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)
        sys.exit(READER_GONE)


def _colour() -> bool:
    return sys.stdout.isatty() and not os.environ.get("NO_COLOR")


@contextmanager
def _progress(source: Source, quiet: bool) -> Iterator[Iterator[bytes]]:
    """The blocks of the source, with a bar on a terminal that shows nothing else, if it is long."""
    alone = quiet or not sys.stdout.isatty()
    long = source.size is not None and source.size >= LONG_FILE
    console = Console(stderr=True)
    with Progress(console=console, disable=not (long and alone and console.is_terminal)) as bar:
        task = bar.add_task("decoding", total=source.size)

        def blocks() -> Iterator[bytes]:
            for block, taken in source.blocks:
                yield block
                bar.advance(task, taken)

        yield blocks()
