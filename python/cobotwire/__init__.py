"""The myCobot serial protocol: a typed API for the arm, and codecs for its line.

    from cobotwire import MyCobot

    with MyCobot("/dev/ttyACM0") as arm:
        arm.send_angles([0, 0, 0, 0, 0, 0], speed=30)

``codec_in_use()`` says which codec does the work: ``native`` (Rust) or ``reference`` (Python).
"""

from typing import TYPE_CHECKING, Any

from cobotwire.codec import chosen as codec_in_use
from cobotwire.editions.mycobot import MyCobot
from cobotwire.errors import (
    CaptureError,
    CobotwireError,
    LinkError,
    MotionTimeout,
    ProtocolError,
    ReplyTimeout,
    UsageError,
)
from cobotwire.limits import Limits
from cobotwire.session import RetryPolicy

__version__ = "0.1.0"

__all__ = [
    "AsyncMyCobot",
    "CaptureError",
    "CobotwireError",
    "Limits",
    "LinkError",
    "MotionTimeout",
    "MyCobot",
    "ProtocolError",
    "ReplyTimeout",
    "RetryPolicy",
    "UsageError",
    "__version__",
    "codec_in_use",
]

if TYPE_CHECKING:
    from cobotwire.editions.mycobot import AsyncMyCobot
else:

    def __getattr__(name: str) -> Any:
        # The asyncio client when it is asked for: asyncio takes longer to import than all of this.
        if name == "AsyncMyCobot":
            from cobotwire.editions.mycobot import AsyncMyCobot

            return AsyncMyCobot
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
