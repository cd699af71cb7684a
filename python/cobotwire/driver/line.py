"""One line that many threads share.

Writing is separated from reading. Whoever gives an order writes it at once. Of those who wait for
answers one reads for all: it feeds the conversation, sends what is to be asked next, and wakes the
others; when its own answer has come, another takes over. So a lone caller reads its own answer
without a switch of threads, and an order never waits for another thread's answer.

Ctrl-C may come anywhere. Locks are taken by ``with`` and held for moments; who reads is a plain
number that its thread can find again; whoever waits looks up now and then. So nothing stays locked.
"""

from __future__ import annotations

import threading
import time
from typing import Any

from cobotwire.driver.watching import Watchers
from cobotwire.errors import LinkError
from cobotwire.session import Conversation, Question, Request, RetryPolicy, Ticket
from cobotwire.session.conversation import CLEAR_SECONDS
from cobotwire.transport import Transport
from cobotwire.transport.timing import times_of

# The longest that the reading thread waits before it looks whether others have queued a question.
SLICE_SECONDS = 0.02
# The longest that the others wait before they look whether anybody reads.
LOOK_SECONDS = 0.05


class SharedLine:
    """The conversation over a link; every method may be called from any thread."""

    def __init__(self, link: Transport, conversation: Conversation, watchers: Watchers) -> None:
        self._link = link
        self._now = times_of(link).now
        self._conversation = conversation
        self._watchers = watchers
        # Around every step of the conversation.
        self._state = threading.Lock()
        # While a frame is written, so that frames do not mix. Taken before the other one.
        self._writing = threading.Lock()
        self._reader: int | None = None
        self._followers: list[threading.Lock] = []

    def tell(self, request: Request, ack_within: float | None) -> None:
        """Send an order at once; wait for its acknowledgement if ``ack_within`` says how long."""
        with self._writing:
            with self._state:
                now = self._now()
                data, order = self._conversation.order(request, now, ack_within)
            self._link.write(data)
        self._watchers.sent(data)
        if order is not None:
            self._await(order, SLICE_SECONDS)
        elif self._leads():
            try:
                self._sweep(now + CLEAR_SECONDS)
            finally:
                self._resign()

    def ask(self, request: Request, policy: RetryPolicy, wait: float | None) -> Question:
        """Ask a question and wait for its reply; gives the question, which is answered."""
        with self._state:
            question = self._conversation.ask(request, self._now(), policy, wait)
        # What lies there already is read first, without waiting.
        self._await(question, 0.0)
        return question

    def listen(self, seconds: float) -> None:
        """Read what comes unasked for so long; the watchers are told of it."""
        until = self._now() + seconds
        while (left := until - self._now()) > 0:
            if self._leads():
                try:
                    self._turn(min(left, SLICE_SECONDS))
                finally:
                    self._resign()
            else:
                # In real time, whatever the link's: it is another thread that is waited for.
                time.sleep(min(left, LOOK_SECONDS))

    def _await(self, ticket: Ticket, longest: float) -> dict[str, Any]:
        try:
            while not ticket.done:
                if self._leads():
                    self._turn(longest)
                    longest = SLICE_SECONDS
                else:
                    self._follow(ticket)
            return ticket.result()
        finally:
            # Ctrl-C and a vanished link leave everything ready for the next call.
            if not ticket.done:
                with self._state:
                    self._conversation.give_up(ticket)
            self._resign()

    def _leads(self) -> bool:
        """Whether this thread reads for all, from now on if nobody did."""
        me = threading.get_ident()
        if self._reader != me:
            with self._state:
                if self._reader is None:
                    self._reader = me
        return self._reader == me

    def _resign(self) -> None:
        if self._reader == threading.get_ident():
            self._reader = None
            self._wake_followers()

    def _turn(self, longest: float) -> None:
        """Read once, let time pass, and send what is to be asked then."""
        conversation = self._conversation
        if longest:
            with self._state:
                wait = conversation.wait(self._now())
            if wait is not None and wait < longest:
                longest = wait
        try:
            data = self._link.read(longest)
        except LinkError as error:
            self._break(error)
            raise
        now = self._now()
        with self._state:
            # What has come is received before time passes, or it would count as late.
            events = conversation.receive(data, now) if data else []
            events += conversation.wake(now)
            due = conversation.due(now)
        if due:
            self._send_question(dry=not data)
        if events:
            self._wake_followers()
            self._watchers.heard(events, now)

    def _send_question(self, dry: bool) -> None:
        with self._writing:
            with self._state:
                data = self._conversation.outgoing(self._now(), dry)
            if not data:
                return
            try:
                self._link.write(data)
            except LinkError as error:
                with self._state:
                    self._conversation.fail_asked(error)
                return
        self._watchers.sent(data)

    def _sweep(self, until: float) -> None:
        """Read what has come, so that no buffer runs over while only orders are given."""
        while data := self._link.read(0):
            now = self._now()
            with self._state:
                events = self._conversation.receive(data, now)
            self._watchers.heard(events, now)
            if now >= until:
                return

    def _break(self, error: LinkError) -> None:
        """The link is gone, and everybody hears of it at once."""
        with self._state:
            self._conversation.fail(error)
        self._wake_followers()
        self._watchers.lost(error)

    def _follow(self, ticket: Ticket) -> None:
        """Wait until the reading thread has something, or none reads."""
        baton = threading.Lock()
        baton.acquire()
        with self._state:
            if ticket.done or self._reader is None:
                return
            self._followers.append(baton)
        # Not without end: whatever becomes of the other thread, this one looks again.
        baton.acquire(timeout=LOOK_SECONDS)

    def _wake_followers(self) -> None:
        if not self._followers:
            return
        with self._state:
            batons, self._followers = self._followers, []
        for baton in batons:
            baton.release()
