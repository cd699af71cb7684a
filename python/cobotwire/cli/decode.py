"""``cobotwire decode``: explain bytes, byte streams and recordings."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING

import click

from cobotwire.capture.byte_source import ByteSource, open_input
from cobotwire.cli.shared.decoded_bytes import decode_bytes
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.exit_codes import USAGE
from cobotwire.cli.shared.input_files import input_files, reading_options
from cobotwire.cli.shared.recordings import notify
from cobotwire.cli.shared.stream_printer import DecodeOptions, print_text
from cobotwire.codec.interface import Listening
from cobotwire.diagnose.counts import StreamCounts
from cobotwire.protocol.counted import counted
from cobotwire.protocol.errors import UnreadableInput
from cobotwire.protocol.printable import printable

if TYPE_CHECKING:
    from cobotwire.capture import CaptureReader


@click.command()
@click.argument("input", nargs=-1, required=True, type=click.Path(), metavar="HEX...|FILE...|-")
@reading_options
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
@click.option("--bytes", "each_byte", is_flag=True, help="Explain each byte, as for HEX.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object per line.")
@click.option("--summary", is_flag=True, help="Print only counts.")
@click.option("--quiet", is_flag=True, help="Print nothing but the summary, if any.")
@uses_edition
def decode(
    edition: str,
    input: tuple[str, ...],
    format: str | None,
    ports: tuple[int, ...],
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

    A recording (pcapng, which other subcommands write with --record) is decoded packet by packet.
    Each frame is decoded in the direction in which it was sent, and printed with its time. If a
    packet does not state its direction, --direction says which messages it holds.

    FILE may also be raw bytes, hex text, bytes as Python prints them, the TCP packets of a pcap
    file, or the output of socat -x, xxd, hexdump -C, od, candump, Saleae Logic, PulseView or
    pymycobot's debug log. The format is detected from the first 512 bytes, and reported. Other text
    is rejected, so that it is not decoded by mistake. --raw, --hex and --read-as choose the format.

    \b
      cobotwire decode FE FE 06 21 01 00 1D 14 FA
      cobotwire decode capture.bin --summary
      cobotwire decode monday.bin tuesday.bin captures/ '*.hex' --summary
      cobotwire decode arm.pcapng
      cobotwire decode tcpdump.pcap --tcp-port 9001
      cat capture.hex | cobotwire decode - --hex --json

    Exit codes: 0 all bytes are legal frames; 1 some are not, or a file ends too early or lacks
    bytes; 2 a file is empty or cannot be read; 141 the reader of the output closed it.
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    quiet = quiet or summary
    options = DecodeOptions(edition, direction, accept_unknown, each_byte, as_json, quiet)
    files = input_files(input)
    counts = StreamCounts()
    unreadable = incomplete = False
    try:
        for names in [input] if files is None else [(name,) for name in files]:
            several = files is not None and len(files) > 1
            if several:
                options = _name_file(options, names[0])
            try:
                source = open_input(names, format, notify, ports)
                incomplete |= _decode(source, options, counts)
            except UnreadableInput as error:
                if not several:
                    summary &= bool(counts.bytes)
                    raise
                notify(str(error))
                unreadable = True
    finally:
        # Ctrl-C prints the counts up to that point.
        if summary:
            print_text(_counts_json(counts) if as_json else "\n".join(_counts_lines(counts)))
    sys.exit(USAGE if unreadable else int(incomplete or not counts.only_legal))


def _decode(
    source: ByteSource | CaptureReader, options: DecodeOptions, counts: StreamCounts
) -> bool:
    """Decode an input; return whether something is missing at its end or within."""
    if isinstance(source, ByteSource):
        decode_bytes(source, options, counts)
        return bool(source.missing)
    # Imported here, because most input is not a recording.
    from cobotwire.cli.shared.decoded_recording import decode_recording

    return decode_recording(source, options, counts)


def _name_file(options: DecodeOptions, name: str) -> DecodeOptions:
    """Print the heading of one of several files; return the options to decode it."""
    if not options.quiet and not options.as_json:
        print_text(f"{printable(name)}:")
    return options._replace(file=name)


def _counts_lines(counts: StreamCounts) -> Iterator[str]:
    noise, kinds = counts.noise, counts.findings.kinds
    sums = (counts.bytes, "byte"), (counts.frames.total(), "frame"), (counts.resyncs, "resync")
    yield ", ".join(counted(*each) for each in sums)
    yield from (f"  {count:>10} x {name}" for name, count in counts.frames.most_common())
    yield f"{counted(noise.total(), 'byte')} of noise"
    yield from (f"  {count:>10} {reason}" for reason, count in noise.most_common())
    yield f"{counted(kinds.total(), 'finding')}"
    yield from (f"  {count:>10} x {kind}" for kind, count in kinds.most_common())
    if diagnosis := str(counts.findings):
        yield f"diagnosis: {diagnosis}"


def _counts_json(counts: StreamCounts) -> str:
    return json.dumps({"kind": "summary", **counts.as_dict()})
