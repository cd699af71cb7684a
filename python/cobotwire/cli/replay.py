"""``cobotwire replay``: a recording as a timeline, or as an arm that answers as it did then."""

from __future__ import annotations

import json
from typing import Any

import click

from cobotwire.capture import CaptureReader, Packet, read
from cobotwire.cli.recorded import ARROWS, codec_of, tell_the_end
from cobotwire.cli.serving import say, serve
from cobotwire.codec.interface import Codec
from cobotwire.errors import ProtocolError, UsageError
from cobotwire.explain import summary
from cobotwire.sim import Heard, PtyPort, ReplayedArm
from cobotwire.table import Direction


@click.command()
@click.argument("file", type=click.Path())
@click.option("--serve", "as_arm", is_flag=True, help="Answer on a pseudo-terminal until Ctrl-C.")
@click.option("--speed", type=float, default=1.0, help="With --serve: 2 halves the delays.")
@click.option("--line", type=int, default=0, help="With --serve: which line, if there are several.")
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object a packet.")
@click.pass_obj
def replay(edition: str, file: str, as_arm: bool, speed: float, line: int, as_json: bool) -> None:
    """Print the recording FILE as a timeline: seconds, direction, bytes, meaning.

    With --serve, the first line is the port to open; there a request that was recorded is answered
    as it was, with the same delays and the same noise. The edition is the recording's own, as far
    as it names one of ours.
    """
    with read(file) as capture:
        if not as_arm:
            _timeline(capture, edition, as_json)
            tell_the_end(capture)
            return
        arm = _arm(capture, edition, speed, line)
        tell_the_end(capture)
    serve(PtyPort(arm))


def _arm(capture: CaptureReader, edition: str, speed: float, line: int) -> ReplayedArm:
    if not 0 < speed <= 1e6:
        raise UsageError("speed", speed, "above 0, up to 1000000")
    packets = [packet for packet in capture if packet.interface == line]
    if not 0 <= line < len(capture.interfaces):
        raise UsageError("line", line, f"0..{len(capture.interfaces) - 1}")
    arm = ReplayedArm(packets, codec_of(capture, line, edition), speed=speed, watch=_show)
    if not arm.requests:
        raise UsageError("FILE", capture.name, "a recording in which something is sent")
    return arm


def _show(heard: Heard) -> None:
    answer = "was not recorded" if heard.answer is None else f"answered by {heard.answer} bytes"
    say(f"heard   {heard.data.hex(' ').upper()}   {answer}")


def _timeline(capture: CaptureReader, edition: str, as_json: bool) -> None:
    start: int | None = None
    for packet in capture:
        start = packet.time_ns if start is None else start
        meaning = _meaning(packet, codec_of(capture, packet.interface, edition))
        after = (packet.time_ns - start) / 1e9
        if as_json:
            say(json.dumps(_as_json(capture, packet, after, meaning)))
            continue
        several = f" line {packet.interface}" if len(capture.interfaces) > 1 else ""
        data = packet.data.hex(" ").upper()
        say(f"{after:10.6f}{several} {ARROWS[packet.direction]} {data}   {meaning}{_late(packet)}")


def _meaning(packet: Packet, codec: Codec) -> str:
    if packet.kind == "noise":
        return f"noise ({packet.reason})"
    if packet.kind == "bytes" or packet.direction == "unknown":
        return "bytes"
    try:
        return summary(codec.decode(_way(packet), packet.data))
    except ProtocolError as error:
        # Another edition than that by which it was cut.
        return str(error)


def _way(packet: Packet) -> Direction:
    return "request" if packet.direction == "sent" else "reply"


def _late(packet: Packet) -> str:
    if not packet.pieces:
        return ""
    seconds = (packet.pieces[-1].time_ns - packet.time_ns) / 1e9
    return f"   (in {len(packet.pieces)} pieces, the last after {seconds:.6f} s)"


def _as_json(capture: CaptureReader, packet: Packet, after: float, meaning: str) -> dict[str, Any]:
    pieces = [
        {"size": size, "after": (time_ns - packet.time_ns) / 1e9} for size, time_ns in packet.pieces
    ]
    return {
        "time_ns": packet.time_ns,
        "after": after,
        "url": capture.interfaces[packet.interface].url,
        "direction": packet.direction,
        "kind": packet.kind,
        "reason": packet.reason,
        "data": packet.data.hex(" ").upper(),
        "meaning": meaning,
        "pieces": pieces,
    }
