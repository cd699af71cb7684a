"""Import the maker's library pymycobot 4.0.7 unmodified, and capture what its classes write."""

from __future__ import annotations

import sys
import threading
import warnings
from collections.abc import Sequence
from functools import lru_cache, partial
from typing import Any

from pymycobot_ports import RecordingPort, Written

with warnings.catch_warnings():
    # Its import uses features that Python 3.11 deprecates (locale.getdefaultlocale). We cannot fix
    # that, and marks of pytest do not apply to imports.
    warnings.simplefilter("ignore")
    import pymycobot
    from pymycobot import CommandGenerator, MyArmC, MyArmM
    from pymycobot.common import DataProcessor, read, write
    from pymycobot.error import calibration_parameters
    from pymycobot.robot_info import RobotLimit

__all__ = ["RobotLimit", "library", "peer_on", "without_port", "written"]


def library(name: str) -> Any:
    """Return a class of the library by its name; ``Mercury (A1)`` is the class Mercury."""
    return getattr(pymycobot, name.partition(" ")[0])


def peer_on(name: str, port: Any) -> Any:
    """Make an object of one of its classes, without opening a port or sleeping 1.5 s."""
    kind = library(name)
    peer = object.__new__(kind)
    if issubclass(kind, CommandGenerator):
        CommandGenerator.__init__(peer)
        # Most modules have an argument check of their own under this name.
        check = getattr(sys.modules[kind.__module__], "calibration_parameters", None)
        peer.calibration_parameters = check or calibration_parameters
    elif issubclass(kind, MyArmC | MyArmM):
        DataProcessor.__init__(peer)
        peer.calibration_parameters = partial(calibration_parameters, class_name=kind.__name__)
    else:
        DataProcessor.__init__(peer)
        peer.calibration_parameters = peer.parametric_verification
        peer._write, peer._read = partial(write, peer), partial(read, peer)
    peer.lock = threading.Lock()
    peer.thread_lock = True
    peer._serial_port = port
    return peer


@lru_cache
def without_port(name: str) -> Any:
    """Return one of its classes on a port that only records."""
    return peer_on(name, RecordingPort())


def written(who: Any, method: str, arguments: Sequence[Any]) -> bytes:
    """Return the first bytes that a call writes, or raise what the call raises before that."""
    try:
        getattr(who, method)(*arguments)
    except Written as port:
        return port.data
    raise AssertionError(f"{method} wrote nothing")
