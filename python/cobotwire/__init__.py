"""The myCobot serial protocol: a typed API for the arm, and codecs for its line.

    from cobotwire import MyCobot

    with MyCobot("/dev/ttyACM0") as arm:
        arm.send_angles([0, 0, 0, 0, 0, 0], speed=30)

``codec_in_use()`` says which codec does the work: ``native`` (Rust) or ``reference`` (Python).
"""

from cobotwire.codec import chosen as codec_in_use
from cobotwire.editions.mycobot import MyCobot
from cobotwire.errors import (
    CaptureError,
    CobotwireError,
    LinkError,
    ProtocolError,
    ReplyTimeout,
    UsageError,
)

__version__ = "0.1.0"

__all__ = [
    "CaptureError",
    "CobotwireError",
    "LinkError",
    "MyCobot",
    "ProtocolError",
    "ReplyTimeout",
    "UsageError",
    "__version__",
    "codec_in_use",
]
