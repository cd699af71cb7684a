"""Run the session with pymycobot, unmodified, and with our two clients."""

from __future__ import annotations

import asyncio
import contextlib
import io
import warnings
from collections.abc import Callable
from typing import Any

from cobotwire.editions.mycobot280 import AsyncMyCobot280, MyCobot280
from cobotwire.protocol.errors import CobotwireError
from referee.calls import SESSION

# Opens a URL, makes all calls and closes it; returns the failed calls, each with its error.
Play = Callable[[str], list[str]]


def _failed(name: str, result: Any) -> list[str]:
    return [f"{name}: {result!r}"] if result is None or result == -1 else []


def pymycobot_serial(url: str) -> list[str]:
    """Run the session with the maker's class for a serial port."""
    return _pymycobot(lambda kinds: kinds.MyCobot280(url))


def pymycobot_socket(url: str) -> list[str]:
    """Run the session with the maker's class for TCP."""
    host, _, port = url.removeprefix("socket://").rpartition(":")
    return _pymycobot(lambda kinds: kinds.MyCobot280Socket(host, int(port)))


def _pymycobot(opened: Callable[[Any], Any]) -> list[str]:
    with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
        # Its import uses deprecated features, and pymycobot prints while it decodes.
        warnings.simplefilter("ignore")
        import pymycobot

        arm = opened(pymycobot)
        failures: list[str] = []
        for call in SESSION:
            try:
                failures += _failed(call.name, getattr(arm, call.name)(*call.arguments))
            except Exception as error:  # any exception is listed, and the session continues
                failures.append(f"{call.name}: {type(error).__name__}: {error}")
        arm.close()
    return failures


def ours_blocking(url: str) -> list[str]:
    """Run the session with our blocking client."""
    failures = []
    with MyCobot280(url) as arm:
        for call in SESSION:
            try:
                getattr(arm, call.name)(*call.arguments)
            except CobotwireError as error:
                failures.append(f"{call.name}: {error}")
    return failures


def ours_asyncio(url: str) -> list[str]:
    """Run the session with our asyncio client."""
    return asyncio.run(_ours_asyncio(url))


async def _ours_asyncio(url: str) -> list[str]:
    failures = []
    async with AsyncMyCobot280(url) as arm:
        for call in SESSION:
            try:
                await getattr(arm, call.name)(*call.arguments)
            except CobotwireError as error:
                failures.append(f"{call.name}: {error}")
    return failures


CLIENTS: dict[str, tuple[str, Play]] = {
    "pymycobot": ("pty", pymycobot_serial),
    "pymycobot socket": ("tcp", pymycobot_socket),
    "cobotwire": ("pty", ours_blocking),
    "cobotwire tcp": ("tcp", ours_blocking),
    "cobotwire asyncio": ("pty", ours_asyncio),
    "cobotwire asyncio tcp": ("tcp", ours_asyncio),
}
