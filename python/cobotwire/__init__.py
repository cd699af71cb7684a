"""The myCobot serial protocol: a typed API for the arm, and codecs for its line.

    from cobotwire import MyCobot280

    with MyCobot280("/dev/ttyACM0") as arm:
        arm.send_angles([0, 0, 0, 0, 0, 0], speed=30)

``connect(port)`` finds out which edition an arm speaks, and returns the client of that edition.
``codec_in_use()`` returns the name of the codec: ``native`` (Rust) or ``reference`` (Python).
"""

from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

__all__ = [
    "AsyncMechArm270",
    "AsyncMyCobot",
    "AsyncMyCobot280",
    "AsyncMyCobot280RDKX5",
    "AsyncMyPalletizer260",
    "CaptureError",
    "CobotwireError",
    "EditionUnknown",
    "Limits",
    "LinkError",
    "MechArm270",
    "MotionTimeout",
    "MyCobot",
    "MyCobot280",
    "MyCobot280RDKX5",
    "MyPalletizer260",
    "ProtocolError",
    "ReplyTimeout",
    "RequestRefused",
    "RetryPolicy",
    "Sample",
    "StreamReport",
    "UsageError",
    "__version__",
    "codec_in_use",
    "connect",
    "connect_async",
    "identify",
]

if TYPE_CHECKING:
    from cobotwire.codec import chosen as codec_in_use
    from cobotwire.editions.mecharm270 import AsyncMechArm270, MechArm270
    from cobotwire.editions.mycobot import AsyncMyCobot, MyCobot
    from cobotwire.editions.mycobot280 import AsyncMyCobot280, MyCobot280
    from cobotwire.editions.mycobot280_rdkx5 import AsyncMyCobot280RDKX5, MyCobot280RDKX5
    from cobotwire.editions.mypalletizer260 import AsyncMyPalletizer260, MyPalletizer260
    from cobotwire.inspect.identification import connect, connect_async, identify
    from cobotwire.protocol.errors import (
        CaptureError,
        CobotwireError,
        EditionUnknown,
        LinkError,
        MotionTimeout,
        ProtocolError,
        ReplyTimeout,
        RequestRefused,
        UsageError,
    )
    from cobotwire.protocol.limits import Limits
    from cobotwire.session.policy import RetryPolicy
    from cobotwire.session.sample import Sample, StreamReport
else:
    # Each name is imported when it is first used. So a program that uses another edition, or only
    # the codec, imports no client of this one. asyncio takes longer to import than all the rest.
    _PLACES = {
        "AsyncMechArm270": "editions.mecharm270",
        "AsyncMyCobot": "editions.mycobot",
        "AsyncMyCobot280": "editions.mycobot280",
        "AsyncMyCobot280RDKX5": "editions.mycobot280_rdkx5",
        "AsyncMyPalletizer260": "editions.mypalletizer260",
        "Limits": "protocol.limits",
        "MechArm270": "editions.mecharm270",
        "MyCobot": "editions.mycobot",
        "MyCobot280": "editions.mycobot280",
        "MyCobot280RDKX5": "editions.mycobot280_rdkx5",
        "MyPalletizer260": "editions.mypalletizer260",
        "RetryPolicy": "session.policy",
        "Sample": "session.sample",
        "StreamReport": "session.sample",
        "codec_in_use": "codec",
        "connect": "inspect.identification",
        "connect_async": "inspect.identification",
        "identify": "inspect.identification",
    }

    def __getattr__(name: str) -> Any:
        if name not in __all__:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        from importlib import import_module

        module = import_module(f"{__name__}.{_PLACES.get(name, 'protocol.errors')}")
        found = getattr(module, "chosen" if name == "codec_in_use" else name)
        globals()[name] = found
        return found

    def __dir__() -> list[str]:
        return sorted({*globals(), *__all__})
