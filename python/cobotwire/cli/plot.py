"""``cobotwire plot``: a recording as a picture."""

from __future__ import annotations

from pathlib import Path

import click

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.capture import CaptureReader
from cobotwire.cli.recorded import capture_in, codec_of, tell_the_end
from cobotwire.cli.source import open_source
from cobotwire.errors import UsageError
from cobotwire.plot import Series, of_recording, of_stream


@click.command()
@click.argument("file", type=click.Path())
@click.option("-o", "--output", required=True, metavar="PICTURE", help="A .png, .svg or .pdf.")
@click.option("--line", type=int, default=0, help="Which line, if the recording has several.")
@click.pass_obj
def plot(edition: str, file: str, output: str, line: int) -> None:
    """Draw the recording FILE: joints, coordinates, frames, noise and reply times over time.

    A raw stream of what an arm said has no times: there it is all drawn over the bytes. Needs
    matplotlib: pip install 'cobotwire[plot]'.
    """
    try:
        from cobotwire.plot.drawing import check_suffix, draw
    except ModuleNotFoundError as error:
        if error.name != "matplotlib":
            raise
        raise UsageError("plot", "without matplotlib", "pip install 'cobotwire[plot]'") from None
    check_suffix(output)
    capture = capture_in((file,))
    name = Path(file).name
    if capture is None:
        source = open_source((file,), None)
        codec = codecs.load(editions.load(edition).TABLE)
        draw(of_stream((block for block, _ in source.blocks), codec), output, name)
        return
    with capture:
        series = _series(capture, line, edition)
        tell_the_end(capture)
        url = capture.interfaces[line].url
    draw(series, output, f"{name}   {url}".strip())


def _series(capture: CaptureReader, line: int, edition: str) -> Series:
    packets = [packet for packet in capture if packet.interface == line]
    if not 0 <= line < len(capture.interfaces):
        raise UsageError("line", line, f"0..{len(capture.interfaces) - 1}")
    return of_recording(packets, codec_of(capture, line, edition))
