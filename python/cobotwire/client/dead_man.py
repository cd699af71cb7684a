"""A dead man's switch: it stops an arm when the signs of life end.

Use it where the source of motions can hang or disappear: a person at a page, a program on another
computer, a policy.
"""

from __future__ import annotations

import threading
from math import inf
from typing import Self

from cobotwire.client.blocking import Client
from cobotwire.client.leading import CHECK_SECONDS
from cobotwire.client.opening import check_seconds

# A stop that waits for a full line must not keep the program from ending.
END_SECONDS = 2.0


class Silence:
    """Computes the time until ``seconds`` have passed without a sign of life. It has no clock."""

    def __init__(self, seconds: float) -> None:
        check_seconds("seconds", seconds)
        self._seconds, self._until = seconds, inf

    def alive(self, now: float) -> None:
        """Note a sign of life."""
        self._until = now + self._seconds

    def rest(self) -> None:
        """Expect no sign of life until the next one."""
        self._until = inf

    def left(self, now: float) -> float:
        """Return the seconds until the arm must be stopped; inf: no sign of life is expected."""
        return self._until - now


class DeadMan:
    """Sends ``stop`` once when :meth:`alive` was not called for some seconds.

        with DeadMan(arm, 0.5) as dead_man:
            for target in targets:
                dead_man.alive()
                arm.send_angles(target, speed=20)

    Entering the block is the first sign of life. After a stop nothing more is sent until the next
    sign of life. Leaving the block sends nothing. It is no emergency stop: a frame can be lost.

    Attributes:
        stops: how often the arm was stopped.
    """

    def __init__(self, arm: Client, seconds: float) -> None:
        """Count seconds by the clock of the arm's transport.

        Raises:
            UsageError: ``seconds`` is not above 0 and below 3600, or the edition has no stop.
        """
        arm.table.in_role("stop")
        self._arm, self._connection, self.stops = arm, arm._connection, 0
        self._silence = Silence(seconds)
        self._changed = threading.Condition()
        self._ended = False
        self._error: Exception | None = None
        self._thread = threading.Thread(target=self._watch, name="cobotwire-dead-man", daemon=True)

    def __enter__(self) -> Self:
        self.alive()
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        with self._changed:
            self._ended = True
            self._changed.notify()
        self._thread.join(END_SECONDS)

    def alive(self) -> None:
        """Note a sign of life; any thread may do so.

        Raises:
            LinkError: the last stop could not be sent. Any other error of sending it, such as one
                of a traffic listener, is raised, too.
        """
        with self._changed:
            self._silence.alive(self._connection.now())
            self._changed.notify()
            error, self._error = self._error, None
        if error is not None:
            raise error

    def rest(self) -> None:
        """Expect no sign of life until the next one: the arm is at rest."""
        with self._changed:
            self._silence.rest()

    def _watch(self) -> None:
        while self._wait():
            try:
                self._arm._stop_all()
            except Exception as error:
                # Also one of a traffic listener: the thread must live to send the next stop.
                self._error = error
            self.stops += 1

    def _wait(self) -> bool:
        """Wait until the arm must be stopped; return False if the block is left before."""
        with self._changed:
            while not self._ended and (left := self._silence.left(self._connection.now())) > 0:
                # A transport may have a clock of its own, which cannot wake this thread.
                longest = left if self._connection.real else CHECK_SECONDS
                self._changed.wait(None if left == inf else longest)
            self._silence.rest()
            return not self._ended
