"""``cobotwire plot``: a recording as a picture."""

from __future__ import annotations

from pathlib import Path

import click

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.capture import CaptureReader
from cobotwire.cli.drawing import drawing
from cobotwire.cli.recorded import capture_in, codec_of, tell_the_end
from cobotwire.cli.source import open_source
from cobotwire.errors import UsageError
from cobotwire.plot import Series, of_recording, of_stream


@click.command()
@click.argument("file", type=click.Path())
@click.option("-o", "--output", required=True, metavar="PICTURE", help="A .png, .svg or .pdf.")
@click.option("--line", type=int, default=0, help="Which line, if the recording has several.")
@click.option("--pose", is_flag=True, help="Draw the arm as it stood last: a stick figure.")
@click.pass_obj
def plot(edition: str, file: str, output: str, line: int, pose: bool) -> None:
    """Draw the recording FILE: joints, coordinates, frames, noise and reply times over time.

    A raw stream of what an arm said has no times: there it is all drawn over the bytes. Needs
    matplotlib: pip install 'cobotwire[plot]'.
    """
    pictures = drawing("drawing")
    pictures.check_suffix(output)
    capture = capture_in((file,))
    name = Path(file).name
    if capture is None:
        source = open_source((file,), None)
        codec = codecs.load(editions.load(edition).TABLE)
        series, title = of_stream((block for block, _ in source.blocks), codec), name
    else:
        with capture:
            series = _series(capture, line, edition)
            tell_the_end(capture)
            codec = codec_of(capture, line, edition)
            title = f"{name}   {capture.interfaces[line].url}".strip()
    if pose:
        drawing("pose").draw_pose(codec.table, _last_joints(series, file), output)
    else:
        pictures.draw(series, output, title)


def _last_joints(series: Series, file: str) -> tuple[float, ...]:
    rows = series.tracks["joints"].rows
    if not rows:
        raise UsageError("FILE", file, "a recording in which the joints are told")
    return rows[-1]


def _series(capture: CaptureReader, line: int, edition: str) -> Series:
    packets = [packet for packet in capture if packet.interface == line]
    if not 0 <= line < len(capture.interfaces):
        raise UsageError("line", line, f"0..{len(capture.interfaces) - 1}")
    return of_recording(packets, codec_of(capture, line, edition))
