"""Choose which of the waiting threads, the leader, reads for all.

When the leader's own reply has come, another thread takes over. Ctrl-C may end the leader's loop
before it can resign, so a leader that makes no progress is replaced. If it was only slow, two
threads read for a while; the lock of the reader keeps the bytes in order.
"""

from __future__ import annotations

import threading

from cobotwire.session import Pending

# The longest that the others wait before they check whether a thread reads.
CHECK_SECONDS = 0.05


class Leading:
    """The thread that leads, and those that follow it.

    Attributes:
        leader: which thread leads; None: no thread does.
        turns: how often leaders have read; if it no longer increases, the leader is gone.
        followers: the locks that wake the threads that wait for the leader.
    """

    def __init__(self, state: threading.Lock) -> None:
        """Store the lock that is held while a request ends, so that its follower notices that."""
        self._state = state
        self.leader: int | None = None
        self.turns = 0
        self.followers: list[threading.Lock] = []

    def take_lead(self) -> bool:
        """Return whether this thread leads; it takes the lead if no other thread has it."""
        me = threading.get_ident()
        if self.leader != me:
            with self._state:
                if self.leader is None:
                    self.leader = me
        return self.leader == me

    def count_turn(self) -> None:
        """Count a read of this thread, which leads."""
        self.turns += 1

    def resign(self) -> None:
        """Let another thread lead, if this one does."""
        if self.leader == threading.get_ident():
            self.leader = None
            if self.followers:
                self.wake_followers()

    def follow(self, pending: Pending, longest: float) -> None:
        """Wait until the leader has read something, or another thread must lead.

        The wait takes ``longest`` seconds at most.
        """
        baton = threading.Lock()
        baton.acquire()
        with self._state:
            leader, turns = self.leader, self.turns
            if pending.done or leader is None:
                return
            self.followers.append(baton)
        if not baton.acquire(timeout=min(longest, CHECK_SECONDS)) and longest >= CHECK_SECONDS:
            with self._state:
                if (leader, turns) == (self.leader, self.turns):
                    # Ctrl-C ended the leader's loop before it could resign, or the leader is very
                    # slow.
                    self.leader = None

    def wake_followers(self) -> None:
        """Have each follower check whether its request is done."""
        if not self.followers:
            return
        with self._state:
            batons, self.followers = self.followers, []
        for baton in batons:
            baton.release()
