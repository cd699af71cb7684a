"""Run the command line on a pseudo-terminal, and read its screen with a terminal emulator."""

from __future__ import annotations

import fcntl
import os
import select
import struct
import subprocess
import termios
import time
from collections.abc import Callable, Sequence
from typing import Self

import pyte

from command_line import PROGRAM

SECONDS = 20.0


class Terminal:
    """A program on a terminal of ``columns`` and ``lines``; it gets a SIGINT from :meth:`press`."""

    def __init__(
        self,
        *words: str,
        columns: int,
        lines: int,
        program: Sequence[str] = PROGRAM,
        **environment: str,
    ) -> None:
        self._master, slave = os.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("4H", lines, columns, 0, 0))
        self.emulated = pyte.HistoryScreen(columns, lines, history=1000, ratio=0.5)
        self._stream = pyte.ByteStream(self.emulated)
        self.process = subprocess.Popen(
            [*program, *words],
            stdin=slave,
            stdout=slave,
            stderr=slave,
            start_new_session=True,
            # The terminal sends its signals to the session that it controls.
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),
            env={**os.environ, "TERM": "xterm-256color", **environment},
        )
        os.close(slave)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.process.kill()
        self.process.wait()
        os.close(self._master)

    def press(self, keys: bytes) -> None:
        """Send keys; ``b"\\x03"`` is Ctrl-C."""
        os.write(self._master, keys)

    def rows(self) -> list[str]:
        """Return all rows since the start, those that have scrolled away included."""
        columns = range(self.emulated.columns)
        gone = ["".join(row[x].data for x in columns) for row in self.emulated.history.top]
        return [row.rstrip() for row in [*gone, *self.emulated.display]]

    def text(self) -> str:
        """Return everything shown without the breaks between rows and the spaces around them."""
        return "".join("".join(self.rows()).split())

    @property
    def has_cursor(self) -> bool:
        """Whether the cursor is shown."""
        return not self.emulated.cursor.hidden

    def until(self, shown: Callable[[], bool]) -> None:
        """Read until ``shown`` is true."""
        end = time.monotonic() + SECONDS
        while not shown() and time.monotonic() < end:
            self.read(0.1)
        assert shown(), "\n".join(self.rows())

    def finish(self) -> int:
        """Read until the program has ended; return its exit code."""
        end = time.monotonic() + SECONDS
        while self.read(0.1) and time.monotonic() < end:
            pass
        return self.process.wait(timeout=SECONDS)

    def read(self, seconds: float = 0) -> bool:
        """Read what comes within some seconds; return False if the program closed the terminal."""
        while select.select([self._master], [], [], seconds)[0]:
            try:
                data = os.read(self._master, 65536)
            except OSError:
                return False
            if not data:
                return False
            self._stream.feed(data)
            seconds = 0
        return True
