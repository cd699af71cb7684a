"""A motion request that a full pseudo-terminal truncates, and the frames that an arm then reads."""

from __future__ import annotations

from cobotwire import codec as codecs
from cobotwire.codec.interface import Frame
from cobotwire.editions.mycobot280 import TABLE

CODEC = codecs.load(TABLE)
# -2.58 degrees are FE FE, so half of this request and a stop would be a legal motion.
ANGLES = (0.0, 0.0, -2.58, 0.0, 0.0, 0.0)
MOTION = CODEC.encode("send_angles", "request", [ANGLES, 50])
STOP = CODEC.encode("stop", "request", [])


def frames(received: bytes) -> list[bytes]:
    """Return the requests that an arm finds in the bytes it received."""
    framer = CODEC.framer("request")
    events = [*framer.feed(received), *framer.flush()]
    return [event.data for event in events if isinstance(event, Frame)]
