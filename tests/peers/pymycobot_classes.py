"""The maker's library pymycobot 4.0.7, imported and built unmodified; what its classes write."""

from __future__ import annotations

import struct
import sys
import threading
import warnings
from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NoReturn

from cobotwire.codec import CodecName
from cobotwire.driver import Driver
from cobotwire.editions.mycobot import MyCobot as OurMyCobot

with warnings.catch_warnings():
    # Importing it compiles and calls what Python 3.11 deprecates (locale.getdefaultlocale). The
    # marks of pytest do not reach imports, and the warnings are not ours to mend.
    warnings.simplefilter("ignore")
    from pymycobot import CommandGenerator, MyCobot, MyCobot280, MyPalletizer260
    from pymycobot.error import MyCobot280DataException, MyCobotDataException

__all__ = ["CLASSES", "REFUSALS", "MyCobot", "MyCobot280", "MyPalletizer260"]
__all__ += ["our_client", "peer_on", "without_port", "written"]

CLASSES: dict[str, type[Any]] = {
    "MyCobot": MyCobot,
    "MyCobot280": MyCobot280,
    "MyPalletizer260": MyPalletizer260,
}

# What it raises before it writes: on purpose, of an argument that its limits rule out; and by
# accident, of a number that does not fit where it shall go (pyserial raises the last one).
REFUSALS = (MyCobotDataException, MyCobot280DataException, struct.error, TypeError, ValueError)


class Written(Exception):
    """Thrown by a port at its first write, so that nobody waits for a reply or writes again."""

    def __init__(self, data: bytes) -> None:
        self.data = data
        super().__init__(data.hex(" "))


class RecordingPort:
    """What pymycobot uses of ``serial.Serial`` before a request is out."""

    def isOpen(self) -> bool:
        return True

    def reset_input_buffer(self) -> None:
        """Nothing ever comes in."""

    def write(self, data: Sequence[int]) -> NoReturn:
        raise Written(bytes(data))


class RecordingLink:
    """The same for our driver: a :class:`cobotwire.transport.Transport`."""

    url = "recording"

    def write(self, data: bytes) -> None:
        raise Written(data)

    def read(self, timeout: float) -> bytes:
        return b""

    def close(self) -> None:
        """There is nothing to give back."""


def peer_on(name: str, port: Any) -> Any:
    """One of its classes as its constructor makes it, but for the port and 1.5 s of sleep."""
    kind = CLASSES[name]
    peer = object.__new__(kind)
    CommandGenerator.__init__(peer)
    # Each module has a check of arguments of its own under this name.
    peer.calibration_parameters = sys.modules[kind.__module__].calibration_parameters
    peer.lock = threading.Lock()
    peer.thread_lock = True
    peer._serial_port = port
    return peer


@lru_cache
def without_port(name: str) -> Any:
    """One of its classes on a port that only records."""
    return peer_on(name, RecordingPort())


def our_client(codec: CodecName, kind: type[Driver] = OurMyCobot) -> Driver:
    """A generated client of ours on a link that only records.

    A new one each time: after a question was given up, a client holds the next one like it back.
    """
    return kind(RecordingLink(), codec=codec)


def written(who: Any, method: str, arguments: Sequence[Any]) -> bytes:
    """The first bytes that a call writes. What the call raises before that goes through."""
    try:
        getattr(who, method)(*arguments)
    except Written as port:
        return port.data
    raise AssertionError(f"{method} wrote nothing")
