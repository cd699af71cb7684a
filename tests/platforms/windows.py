"""Turn this process into one that lacks what Windows lacks, as far as our code can notice.

Modules of the standard library, and pyserial, are imported earlier, so they keep the behaviour of
this system.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import ctypes
import importlib
import logging.handlers
import os
import pathlib
import select
import selectors
import signal
import socket
import stat
import subprocess
import sys
import sysconfig
import tempfile
import types
from collections.abc import Iterable
from typing import Any

# If these were imported later, they would check sys.platform, and fail without the real Windows.
LOADED = (asyncio, concurrent.futures, ctypes, logging.handlers, subprocess, tempfile)
THIRD_PARTY = ("click", "rich.console", "rich.live", "rich.progress", "serial.tools.list_ports")
# Only imported in the test that imports all of our modules.
EXTRAS = (
    *("libcst.codemod", "matplotlib.backends.backend_agg", "matplotlib.font_manager", "pytest"),
    *("mcp.server", "starlette.applications", "uvicorn.server"),
)

ABSENT_MODULES = (
    *("curses", "fcntl", "grp", "posix", "pty", "pwd", "readline", "resource", "syslog"),
    *("termios", "tty"),
)
ABSENT_NAMES: dict[Any, tuple[str, ...]] = {
    # Windows has set_blocking since Python 3.12. O_NOCTTY and O_NONBLOCK stay: pyserial needs them.
    os: (
        *("EFD_CLOEXEC", "EFD_NONBLOCK", "O_CLOEXEC", "O_DIRECTORY"),
        *("chown", "eventfd", "fchmod", "fork", "forkpty", "get_blocking", "getgid", "getpgid"),
        *("getuid", "killpg", "mkfifo", "nice", "openpty", "pread", "preadv", "pwrite"),
        *("register_at_fork", "sched_getaffinity", "sendfile", "set_blocking", "setsid"),
        *("ttyname", "uname"),
    ),
    select: ("epoll", "poll"),
    selectors: ("EpollSelector", "PollSelector"),
    signal: ("SIGALRM", "SIGHUP", "SIGKILL", "SIGPIPE", "SIGUSR1", "alarm", "setitimer"),
    socket: ("TCP_USER_TIMEOUT",),
}
# WSAENOTSOCK
NOT_A_SOCKET = 10038

_select = select.select
_replace = os.replace


def pretend(extras: Iterable[str] = ()) -> None:
    """First import ``extras``. Then remove modules that Windows lacks, and reject calls that fail
    there."""
    for name in (*THIRD_PARTY, *extras):
        importlib.import_module(name)
    sysconfig.get_config_vars()
    # This system's pyserial waits for the port with select().
    posix: Any = importlib.import_module("serial.serialposix")
    posix.select = types.SimpleNamespace(select=_select)
    # Any: what is replaced has more precise types than its replacement.
    modules: dict[str, Any] = sys.modules
    for name in ABSENT_MODULES:
        modules[name] = None
    for module, names in ABSENT_NAMES.items():
        for name in names:
            if hasattr(module, name):
                delattr(module, name)
    # Windows has the module msvcrt, and this system does not.
    modules["msvcrt"] = types.ModuleType("msvcrt")
    modules["selectors"].DefaultSelector = selectors.SelectSelector
    modules["selectors"].SelectSelector._select = staticmethod(_select_sockets)
    modules["select"].select = _select_sockets
    # The default event loop of Windows lacks this method, too.
    modules["asyncio"].SelectorEventLoop.add_reader = _not_implemented
    modules["os"].replace = _replace_closed
    # Path() makes one of these where os.name is "nt", and it works on Windows alone.
    modules[pathlib.Path.__module__].WindowsPath = pathlib.PosixPath
    os.name, sys.platform = "nt", "win32"


def _not_implemented(*_: object) -> None:
    raise NotImplementedError


def _select_sockets(
    read: Iterable[Any], write: Iterable[Any], other: Iterable[Any], timeout: float | None = None
) -> tuple[list[Any], list[Any], list[Any]]:
    """Wait as select() of Windows does, which takes sockets only."""
    for item in (*read, *write):
        number = item if isinstance(item, int) else item.fileno()
        if not stat.S_ISSOCK(os.fstat(number).st_mode):
            raise OSError(NOT_A_SOCKET, "an operation was attempted on something not a socket")
    return _select(read, write, other, timeout)


def _replace_closed(source: Any, target: Any) -> None:
    """Rename as Windows does, which refuses while this process has one of the files open."""
    for name in os.listdir("/proc/self/fd"):
        try:
            opened = os.readlink(f"/proc/self/fd/{name}")
        except FileNotFoundError:  # the descriptor of the listing itself
            continue
        if opened in (os.path.realpath(source), os.path.realpath(target)):
            raise PermissionError(13, "the file is used by a process", str(source))
    _replace(source, target)
