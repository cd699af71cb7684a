"""``cobotwire replay``: print a recording, or serve an arm that replies as recorded."""

from __future__ import annotations

import json
from functools import partial

import click

from cobotwire.capture import CaptureReader
from cobotwire.capture.streams import packets_of_interface
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.line_output import LineOutput
from cobotwire.cli.shared.output import as_hex, fold, print_line
from cobotwire.cli.shared.packet_lines import meaning_of, packet_as_json, packet_line
from cobotwire.cli.shared.recordings import interface_option, open_recording, warn_if_incomplete
from cobotwire.cli.shared.serving import serve
from cobotwire.cli.shared.simulator_output import left_out
from cobotwire.inspect.captured import codec_of_interface
from cobotwire.protocol.errors import UsageError
from cobotwire.simulator import ReplayedArm, ReplayedRequest
from cobotwire.simulator.local import local_server

FASTEST = 1e6


@click.command()
@click.argument("file", type=click.Path())
@click.option("--serve", "as_arm", is_flag=True, help="Serve the recorded arm until Ctrl-C.")
@click.option(
    "--speed", type=float, default=1.0, show_default=True, help="With --serve: 2 halves the delays."
)
@interface_option
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object per packet.")
@uses_edition
def replay(
    edition: str, file: str, as_arm: bool, speed: float, interface: int | None, as_json: bool
) -> None:
    """Print the recording FILE as a timeline: seconds, direction, bytes, meaning.

    With --serve, serve the recorded arm on a pseudo-terminal instead, and print its name. The arm
    replies to each recorded request as recorded, with the same delay and the same noise.

    By default the timeline shows all interfaces, and --serve serves the first one; --interface
    chooses one. The edition is the one that the recording names; --edition applies if it names
    none.
    """
    with open_recording(file) as capture:
        if not as_arm:
            _print_timeline(capture, edition, interface, as_json)
            warn_if_incomplete(capture)
            return
        lines = LineOutput(left_out)
        arm = _arm(capture, edition, speed, interface or 0, lines)
        warn_if_incomplete(capture)
    try:
        serve(local_server(arm), between=[lines.flush])
    finally:
        lines.close()


def _arm(
    capture: CaptureReader, edition: str, speed: float, interface: int, lines: LineOutput
) -> ReplayedArm:
    if not 0 < speed <= FASTEST:
        raise UsageError("speed", speed, f"above 0, up to {FASTEST:.0f}")
    packets = list(packets_of_interface(capture, interface))
    codec = codec_of_interface(capture, interface, edition)
    arm = ReplayedArm(packets, codec, speed=speed, on_request=partial(_print_request, lines))
    if not arm.requests:
        message = f"{capture.name} holds no request, so there is nothing to reply to"
        raise UsageError("FILE", capture.name, message=message)
    return arm


def _print_request(lines: LineOutput, request: ReplayedRequest) -> None:
    size = request.reply_size
    reply = f"replied with {size} bytes" if size else "no reply"
    if size is None:
        reply = "this request was not recorded"
    lines.print(fold(f"received {as_hex(request.data)}   {reply}"))


def _print_timeline(
    capture: CaptureReader, edition: str, interface: int | None, as_json: bool
) -> None:
    start: int | None = None
    for packet in capture if interface is None else packets_of_interface(capture, interface):
        start = packet.time_ns if start is None else start
        meaning = meaning_of(packet, codec_of_interface(capture, packet.interface, edition))
        after = (packet.time_ns - start) / 1e9 if capture.timed else None
        if as_json:
            url = capture.interfaces[packet.interface].url
            print_line(json.dumps(packet_as_json(packet, url, after, meaning)))
            continue
        label = f" interface {packet.interface}" if len(capture.interfaces) > 1 else ""
        print_line(packet_line(packet, after, meaning, label))
