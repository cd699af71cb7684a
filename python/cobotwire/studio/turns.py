"""A lock that threads get in the order in which they request it."""

from __future__ import annotations

import threading


class Turns:
    """Let one thread at a time run a ``with`` block, in the order of their requests.

    With ``threading.Lock``, a thread that polls without a pause could keep all others out.
    """

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._requested = self._ended = 0

    def __enter__(self) -> None:
        with self._changed:
            turn = self._requested
            self._requested += 1
            self._changed.wait_for(lambda: self._ended == turn)

    def __exit__(self, *error: object) -> None:
        with self._changed:
            self._ended += 1
            self._changed.notify_all()
