"""The serial protocols of Elephant Robotics: typed clients for the arms, and codecs.

    from cobotwire import MyCobot280

    with MyCobot280("/dev/ttyACM0") as arm:
        arm.send_angles([0, 0, 0, 0, 0, 0], speed=30)

``connect(port)`` finds out which edition an arm speaks, and returns the client of that edition.
``codec_in_use()`` returns the name of the codec: ``native`` (Rust) or ``reference`` (Python).
"""

from cobotwire.protocol.light import TYPE_CHECKING

__all__ = [
    "AsyncMechArm270",
    "AsyncMercuryA1",
    "AsyncMercuryB1",
    "AsyncMercuryX1",
    "AsyncMyArm300",
    "AsyncMyArmC650",
    "AsyncMyArmM750",
    "AsyncMyBuddy",
    "AsyncMyCobot",
    "AsyncMyCobot280",
    "AsyncMyCobot280RDKX5",
    "AsyncMyCobot320",
    "AsyncMyPalletizer260",
    "AsyncPro400",
    "AsyncPro450",
    "AsyncPro630",
    "AsyncTwoArms",
    "CaptureError",
    "CobotwireError",
    "EditionUnknown",
    "Joint",
    "Limits",
    "LinkError",
    "MechArm270",
    "MercuryA1",
    "MercuryB1",
    "MercuryX1",
    "MotionTimeout",
    "MyArm300",
    "MyArmC650",
    "MyArmM750",
    "MyBuddy",
    "MyCobot",
    "MyCobot280",
    "MyCobot280RDKX5",
    "MyCobot320",
    "MyPalletizer260",
    "Pro400",
    "Pro450",
    "Pro630",
    "ProtocolError",
    "ReplyTimeout",
    "RequestRefused",
    "RetryPolicy",
    "Sample",
    "StreamReport",
    "TwoArms",
    "UsageError",
    "__version__",
    "codec_in_use",
    "connect",
    "connect_async",
    "identify",
]

if TYPE_CHECKING:
    __version__: str
    from cobotwire.client.aio_two_arms import AsyncTwoArms
    from cobotwire.client.two_arms import TwoArms
    from cobotwire.codec import chosen as codec_in_use
    from cobotwire.editions.mecharm270 import AsyncMechArm270, MechArm270
    from cobotwire.editions.mercury_a1 import AsyncMercuryA1, MercuryA1
    from cobotwire.editions.mercury_b1 import AsyncMercuryB1, MercuryB1
    from cobotwire.editions.mercury_x1 import AsyncMercuryX1, MercuryX1
    from cobotwire.editions.myarm300 import AsyncMyArm300, MyArm300
    from cobotwire.editions.myarm_c650 import AsyncMyArmC650, MyArmC650
    from cobotwire.editions.myarm_m750 import AsyncMyArmM750, MyArmM750
    from cobotwire.editions.mybuddy import AsyncMyBuddy, MyBuddy
    from cobotwire.editions.mycobot import AsyncMyCobot, MyCobot
    from cobotwire.editions.mycobot280 import AsyncMyCobot280, MyCobot280
    from cobotwire.editions.mycobot280_rdkx5 import AsyncMyCobot280RDKX5, MyCobot280RDKX5
    from cobotwire.editions.mycobot320 import AsyncMyCobot320, MyCobot320
    from cobotwire.editions.mypalletizer260 import AsyncMyPalletizer260, MyPalletizer260
    from cobotwire.editions.pro400 import AsyncPro400, Pro400
    from cobotwire.editions.pro450 import AsyncPro450, Pro450
    from cobotwire.editions.pro630 import AsyncPro630, Pro630
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
    from cobotwire.protocol.joints import Joint
    from cobotwire.protocol.limits import Limits
    from cobotwire.session.pending import RetryPolicy
    from cobotwire.session.sample import Sample, StreamReport
else:
    # Each name is imported when it is first used. So a program that uses another edition, or only
    # the codec, imports no client of this one. asyncio takes longer to import than all the rest.
    _PLACES = {
        "AsyncMechArm270": "editions.mecharm270",
        "AsyncMercuryA1": "editions.mercury_a1",
        "AsyncMercuryB1": "editions.mercury_b1",
        "AsyncMercuryX1": "editions.mercury_x1",
        "AsyncMyArm300": "editions.myarm300",
        "AsyncMyArmC650": "editions.myarm_c650",
        "AsyncMyArmM750": "editions.myarm_m750",
        "AsyncMyBuddy": "editions.mybuddy",
        "AsyncMyCobot": "editions.mycobot",
        "AsyncMyCobot280": "editions.mycobot280",
        "AsyncMyCobot280RDKX5": "editions.mycobot280_rdkx5",
        "AsyncMyCobot320": "editions.mycobot320",
        "AsyncMyPalletizer260": "editions.mypalletizer260",
        "Joint": "protocol.joints",
        "AsyncPro400": "editions.pro400",
        "Pro400": "editions.pro400",
        "AsyncPro450": "editions.pro450",
        "Pro450": "editions.pro450",
        "AsyncPro630": "editions.pro630",
        "Pro630": "editions.pro630",
        "AsyncTwoArms": "client.aio_two_arms",
        "Limits": "protocol.limits",
        "MechArm270": "editions.mecharm270",
        "MercuryA1": "editions.mercury_a1",
        "MercuryB1": "editions.mercury_b1",
        "MercuryX1": "editions.mercury_x1",
        "MyArm300": "editions.myarm300",
        "MyArmC650": "editions.myarm_c650",
        "MyArmM750": "editions.myarm_m750",
        "MyBuddy": "editions.mybuddy",
        "MyCobot": "editions.mycobot",
        "MyCobot280": "editions.mycobot280",
        "MyCobot280RDKX5": "editions.mycobot280_rdkx5",
        "MyCobot320": "editions.mycobot320",
        "MyPalletizer260": "editions.mypalletizer260",
        "RetryPolicy": "session.pending",
        "Sample": "session.sample",
        "StreamReport": "session.sample",
        "TwoArms": "client.two_arms",
        "codec_in_use": "codec",
        "connect": "inspect.identification",
        "connect_async": "inspect.identification",
        "identify": "inspect.identification",
    }

    def __getattr__(name: str) -> object:
        if name not in __all__:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        if name == "__version__":
            # That of the installed distribution; Cargo.toml states it once for all parts.
            try:
                from cobotwire._native import __version__ as version
            except ImportError:
                from importlib.metadata import version as installed

                version = installed("cobotwire")
            return version
        from importlib import import_module

        module = import_module(f"{__name__}.{_PLACES.get(name, 'protocol.errors')}")
        found = getattr(module, "chosen" if name == "codec_in_use" else name)
        globals()[name] = found
        return found

    def __dir__() -> list[str]:
        return sorted({*globals(), *__all__})
