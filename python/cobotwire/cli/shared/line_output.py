"""Print lines of a server, which must not wait for the reader of its output."""

from __future__ import annotations

import os
import stat
import sys
import time
from collections import deque
from collections.abc import Callable

from cobotwire.cli.shared.output import discard_output, print_line
from cobotwire.transport.waiting import is_ready

# Bytes that are kept for a reader that is slow: some thousand lines.
KEPT = 1 << 20
# A writable pipe takes at least this many bytes without waiting.
PIECE = 512
# At the end a slow reader may take this long for the lines that are left.
CLOSING_SECONDS = 1.0


class LineOutput:
    """Prints lines to standard output; into a pipe only as fast as its reader takes them.

    A pipe that nobody reads is full after some hundred lines, and the next write would stop the
    server and the arm. So lines wait in memory. If too many wait, further ones are left out, and a
    line says how many.
    """

    def __init__(self, left_out: Callable[[int], str]) -> None:
        """``left_out`` returns the line for a number of lines that were left out."""
        self._format_left_out = left_out
        self._left_out = 0
        self._pipe = _pipe()
        self._print_line: Callable[[str], None] = print_line
        self._waiting: deque[bytes] = deque()
        self._size = 0

    def print(self, line: str) -> None:
        """Print a line as soon as the reader takes it; do nothing if the reader is gone."""
        if self._pipe is None:
            self._print_line(line)
            return
        if self._left_out or self._size > KEPT:
            self._left_out += 1
        else:
            self._add(line)
        self.flush()

    def redirect(self, print_line: Callable[[str], None]) -> None:
        """Pass each line for a terminal to ``print_line``, because a live table is shown."""
        self._print_line = print_line

    def flush(self) -> None:
        """Print what the reader takes now; call this from time to time."""
        while self._waiting and self._can_write(0.0):
            self._write()
            if self._left_out and not self._waiting:
                self._add(self._format_left_out(self._left_out))
                self._left_out = 0

    def close(self) -> None:
        """Print what is left, if the reader takes it within a second."""
        deadline = time.monotonic() + CLOSING_SECONDS
        while self._waiting and self._can_write(max(0.0, deadline - time.monotonic())):
            self.flush()

    def _add(self, line: str) -> None:
        data = f"{line}\n".encode(sys.stdout.encoding, "backslashreplace")
        self._waiting.append(data)
        self._size += len(data)

    def _can_write(self, seconds: float) -> bool:
        assert self._pipe is not None, "lines wait only for a pipe"
        return is_ready(self._pipe, seconds, writing=True)

    def _write(self) -> None:
        assert self._pipe is not None, "lines wait only for a pipe"
        line = self._waiting.popleft()
        try:
            taken = os.write(self._pipe, line[:PIECE])
        except BrokenPipeError:
            self._pipe = None
            self._waiting.clear()
            discard_output()
            return
        self._size -= taken
        if taken < len(line):
            self._waiting.appendleft(line[taken:])


def _pipe() -> int | None:
    """Return the descriptor of standard output if it is a pipe or socket that can be waited for."""
    try:
        descriptor = sys.stdout.fileno()
        mode = os.fstat(descriptor).st_mode
    except (OSError, ValueError):
        return None
    is_pipe = stat.S_ISFIFO(mode) or stat.S_ISSOCK(mode)
    return descriptor if os.name == "posix" and is_pipe else None
