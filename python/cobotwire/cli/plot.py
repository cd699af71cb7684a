"""``cobotwire plot``: draw a recording."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import click

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.capture import CaptureReader
from cobotwire.capture.byte_source import ByteSource, open_input
from cobotwire.capture.streams import packets_of_interface
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.input_files import reading_options
from cobotwire.cli.shared.output import report_written
from cobotwire.cli.shared.recordings import interface_option, notify, warn_if_incomplete
from cobotwire.codec.interface import Codec
from cobotwire.inspect.captured import codec_of_interface
from cobotwire.inspect.plot import (
    Series,
    check_output,
    draw_charts,
    draw_pose,
    series_of_bytes,
    series_of_packets,
)
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.printable import printable


@click.command()
@click.argument("file", type=click.Path())
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(),
    metavar="PICTURE",
    help="A .png, .svg or .pdf file.",
)
@reading_options
@interface_option
@click.option("--pose", is_flag=True, help="Draw the last pose of the arm as a stick figure.")
@uses_edition
def plot(
    edition: str,
    file: str,
    output: str,
    format: str | None,
    ports: tuple[int, ...],
    interface: int | None,
    pose: bool,
) -> None:
    """Draw joints, coordinates, frames, noise and reply times of the recording FILE over time.

    The first interface is drawn, unless --interface chooses another one. FILE may also be what
    other programs wrote, as for cobotwire decode. Raw bytes have no times, so they are drawn over
    the offset in bytes. Plotting needs matplotlib: pip install 'cobotwire[plot]'.
    """
    check_output(output)
    source = open_input((file,), format, notify, ports)
    title = [printable(Path(file).name)]
    if isinstance(source, ByteSource):
        codec = codecs.load(editions.load(edition).TABLE)
        series = series_of_bytes((block for block, _ in source.blocks), codec)
        title.append(f"edition {codec.table.edition}")
    else:
        series, codec = _read_recording(source, interface or 0, edition)
        url = source.interfaces[interface or 0].url
        title += [printable(url), f"edition {codec.table.edition}"]
        if source.dated:
            begin = datetime.fromtimestamp(series.start_ns / 1e9, UTC)
            title.append(f"{begin:%Y-%m-%d %H:%M:%S} UTC")
    if not pose:
        draw_charts(series, output, "   ".join(filter(None, title)))
    elif joints := series.tracks["joints"].rows:
        draw_pose(codec.table, joints[-1], output)
    else:
        message = f"{file} holds no reply with joint angles, so there is no pose to draw"
        raise UsageError("FILE", file, message=message)
    report_written(output)


def _read_recording(capture: CaptureReader, interface: int, edition: str) -> tuple[Series, Codec]:
    with capture:
        packets = list(packets_of_interface(capture, interface))
        warn_if_incomplete(capture)
    if len(capture.interfaces) > 1:
        last = len(capture.interfaces) - 1
        what = f"only interface {interface}: {printable(capture.interfaces[interface].url)}"
        notify(f"drawing {what}; --interface chooses another of 0..{last}")
    if not capture.timed:
        message = f"{capture.name} has no times, so it cannot be drawn over time"
        raise UsageError("FILE", capture.name, message=message)
    codec = codec_of_interface(capture, interface, edition)
    return series_of_packets(packets, codec), codec
