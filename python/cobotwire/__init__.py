"""The serial protocols of Elephant Robotics: typed clients for the arms, and codecs.

    from cobotwire import MyCobot280

    with MyCobot280("/dev/ttyACM0") as arm:
        arm.send_angles([0, 0, 0, 0, 0, 0], speed=30)

``connect(port)`` finds out which edition an arm speaks, and returns the client of that edition.
``codec_in_use()`` returns the name of the codec: ``native`` (Rust) or ``reference`` (Python).
"""

from importlib import import_module

from cobotwire.editions.clients import EDITIONS

# The module of each name. It is imported when the name is first used, so a program that uses
# another edition, or only the codec, does not import this edition's client. asyncio takes longer to
# import than the rest. Type checkers read ``__init__.pyi``.
_PLACES = {
    **{name: f"editions.{edition}" for name, edition in EDITIONS.items()},
    "AsyncDeadMan": "client.aio_dead_man",
    "AsyncTwoArms": "client.aio_two_arms",
    "CaptureError": "protocol.errors",
    "CobotwireError": "protocol.errors",
    "DeadMan": "client.dead_man",
    "EditionUnknown": "protocol.errors",
    "FollowFailed": "protocol.errors",
    "FollowReport": "session.paths",
    "Joint": "protocol.joints",
    "Limits": "protocol.limits",
    "LinkError": "protocol.errors",
    "MotionTimeout": "protocol.errors",
    "PathLimits": "session.paths",
    "ProtocolError": "protocol.errors",
    "ReplyTimeout": "protocol.errors",
    "RequestRefused": "protocol.errors",
    "RetryPolicy": "session.pending",
    "Sample": "session.sample",
    "StreamReport": "session.sample",
    "TwoArms": "client.two_arms",
    "UsageError": "protocol.errors",
    "Waypoint": "session.paths",
    "codec_in_use": "codec",
    "connect": "inspect.identification",
    "connect_async": "inspect.identification",
    "identify": "inspect.identification",
}

__all__ = sorted([*_PLACES, "__version__"])


def __getattr__(name: str) -> object:
    if name == "__version__":
        # The version of the installed distribution; Cargo.toml states it once for all parts.
        try:
            from cobotwire._native import __version__ as version
        except ImportError:
            from importlib.metadata import version as installed

            version = installed("cobotwire")
        return version
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = import_module(f"{__name__}.{_PLACES[name]}")
    found = getattr(module, "chosen" if name == "codec_in_use" else name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
