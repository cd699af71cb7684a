"""The watching process: forked from the forwarder, so that neither takes time from the other."""

from __future__ import annotations

import os
import signal
import sys
import time
import traceback
from collections.abc import Callable
from typing import NoReturn

from cobotwire.protocol.errors import CaptureError

# How many seconds the watching process has at the end to finish a recording.
END_SECONDS = 5.0

# Called with the pipe of the copies, and with a function to call when watching begins.
Watch = Callable[[int, Callable[[], None]], None]


class WatchingProcess:
    """Calls ``watch`` in a process of its own, which ends with the forwarder.

    Attributes:
        copies: the pipe for :class:`~cobotwire.inspect.tap.copies.Copies`.
        watches: whether watching has begun. Otherwise the process has reported an error.
    """

    def __init__(self, watch: Watch) -> None:
        """Start it, and wait until watching begins.

        From now on this process ignores Ctrl-C and SIGTERM until it sets handlers. The watching
        process always ignores them, since a terminal sends Ctrl-C to both processes.
        """
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)
        reading, self.copies = os.pipe()
        ready, tell_ready = os.pipe()
        sys.stdout.flush()
        self._number = os.fork()
        if not self._number:
            os.close(self.copies)
            os.close(ready)
            _run(watch, reading, tell_ready)
        os.close(reading)
        os.close(tell_ready)
        self.watches = os.read(ready, 1) != b""
        os.close(ready)

    def end(self) -> int:
        """Wait until it has ended, after the copies were closed; return its exit code.

        Raises:
            CaptureError: it does not end, or something else has ended it.
        """
        deadline = time.monotonic() + END_SECONDS
        while time.monotonic() < deadline:
            ended, status = os.waitpid(self._number, os.WNOHANG)
            code = os.waitstatus_to_exitcode(status) if ended else 0
            if code < 0:
                raise _incomplete(f"was ended by {signal.Signals(-code).name}")
            if ended:
                return code
            time.sleep(0.01)
        raise _incomplete(f"({self._number}) has not ended in {END_SECONDS:.0f} s")


def _incomplete(what: str) -> CaptureError:
    return CaptureError("tap", 0, f"a recording may be incomplete: the watching process {what}")


def _run(watch: Watch, copies: int, tell_ready: int) -> NoReturn:
    def begin() -> None:
        os.write(tell_ready, b"1")
        os.close(tell_ready)

    code: object = 1
    try:
        watch(copies, begin)
        code = 0
    except SystemExit as end:
        code = end.code
    except BaseException:
        traceback.print_exc()
    finally:
        os._exit(code if isinstance(code, int) else 1)
