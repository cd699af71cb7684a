"""Decode what Wireshark captured between a program and an arm on TCP: decode_wireshark.py FILE.

A second argument is the TCP port of the arm (9000). Each line shows the time, the sender, and
the message; bytes outside frames are noise. tshark, which comes with Wireshark, puts the segments
of each connection in order. In Wireshark itself, the dissector shows the same: docs/wireshark.md.
"""

import subprocess
import sys
from collections.abc import Iterator

from cobotwire import codec
from cobotwire.codec.interface import Frame, Framer
from cobotwire.diagnose.explain import format_message
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.protocol.errors import ProtocolError

FIELDS = ("frame.time_relative", "tcp.stream", "tcp.srcport", "tcp.payload")


def main(file: str, port: int = 9000) -> None:
    """Print every message of a capture, in the order in which they were completed."""
    ours = codec.load(TABLE)
    # A framer for each direction of each connection: a frame may span segments.
    framers: dict[tuple[str, bool], Framer] = {}
    for time, stream, from_arm, data in segments(file, port):
        if (stream, from_arm) not in framers:
            framers[stream, from_arm] = ours.framer("reply" if from_arm else "request")
        for event in framers[stream, from_arm].feed(data):
            who = "arm " if from_arm else "host"
            print(f"{time:9.6f} {who} {meaning(event)}")


def segments(file: str, port: int) -> Iterator[tuple[float, str, bool, bytes]]:
    """Yield the time, the connection, whether the arm sent it, and the bytes of each segment."""
    selected = f"tcp.port == {port} && tcp.len > 0 && !tcp.analysis.retransmission"
    command = ["tshark", "-r", file, "-Y", selected, "-T", "fields"]
    for name in FIELDS:
        command += ["-e", name]
    done = subprocess.run(command, capture_output=True, text=True, check=True)  # noqa: S603
    for line in done.stdout.splitlines():
        time, stream, source, payload = line.split("\t")
        yield float(time), stream, source == str(port), bytes.fromhex(payload)


def meaning(event: object) -> str:
    """Return a frame as a call or its result, and noise as bytes."""
    if not isinstance(event, Frame):
        return f"noise {event}"
    try:
        return format_message(event.message)
    except ProtocolError as error:
        return f"not allowed: {error}"


if __name__ == "__main__":
    main(sys.argv[1], *map(int, sys.argv[2:]))
