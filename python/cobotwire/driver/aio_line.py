"""One line on an event loop, shared by its tasks: the conversation over an asynchronous link."""

from __future__ import annotations

import asyncio
import time
from functools import partial
from typing import Any

from cobotwire.driver.watching import Watchers
from cobotwire.errors import LinkError
from cobotwire.session import Conversation, Question, Request, RetryPolicy, Ticket
from cobotwire.transport import Transport
from cobotwire.transport.aio import attach

# A timer that is so little early or late is left as it is.
TIMER_SLACK = 0.0005


class AsyncLine:
    """Every method is called in the thread of the loop that was running when it was made."""

    def __init__(self, link: Transport, conversation: Conversation, watchers: Watchers) -> None:
        self._loop = asyncio.get_running_loop()
        self._url = link.url
        self._conversation = conversation
        self._watchers = watchers
        self._lost: LinkError | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._timer_at = 0.0
        self._link = attach(link, self._turn)

    async def tell(self, request: Request, ack_within: float | None) -> None:
        """Send an order at once; wait for its acknowledgement if ``ack_within`` says how long."""
        now = time.monotonic()
        data, order = self._conversation.order(request, now, ack_within)
        try:
            await self._write(data)
            self._watchers.sent(data)
            self._turn()
            if order is not None:
                await self._await(order)
        finally:
            if order is not None:
                self._conversation.give_up(order)

    async def ask(self, request: Request, policy: RetryPolicy, wait: float | None) -> Question:
        """Ask a question and wait for its reply; gives the question, which is answered."""
        question = self._conversation.ask(request, time.monotonic(), policy, wait)
        try:
            self._turn()
            await self._await(question)
        finally:
            # A call that was cancelled leaves everything ready for the next one.
            if not question.done:
                self._conversation.give_up(question)
                self._turn()
        return question

    def close(self) -> None:
        """Give the link back; whoever waits hears of it."""
        self._link.close()
        self._end(LinkError(self._url, "it is closed"))

    async def _await(self, ticket: Ticket) -> dict[str, Any]:
        if not ticket.done:
            over: asyncio.Future[None] = self._loop.create_future()
            ticket.waker = partial(_wake, over)
            await over
        return ticket.result()

    async def _write(self, data: bytes) -> None:
        if self._lost is not None:
            raise LinkError(self._lost.url, self._lost.detail)
        over: asyncio.Future[None] = self._loop.create_future()
        if not self._link.write(data, partial(_written, over)):
            await over

    def _turn(self) -> None:
        """Take what has come, let time pass, send what is to be asked, and set the timer."""
        conversation = self._conversation
        try:
            data = b"" if self._lost is not None else self._link.read()
        except LinkError as error:
            self._watchers.lost(error)
            self._end(error)
            return
        now = time.monotonic()
        events = conversation.receive(data, now) if data else []
        events += conversation.wake(now)
        if self._lost is not None:
            conversation.fail(self._lost)
        elif conversation.due(now):
            self._send_question(now, dry=not data)
        wait = conversation.wait(now)
        if wait is not None:
            self._wake_at(now + wait)
        if events:
            self._watchers.heard(events, now)

    def _send_question(self, now: float, dry: bool) -> None:
        data = self._conversation.outgoing(now, dry)
        if not data:
            return
        try:
            self._link.write(data, self._question_written)
        except LinkError as error:
            self._conversation.fail_asked(error)
            return
        self._watchers.sent(data)

    def _question_written(self, error: LinkError | None) -> None:
        if error is not None:
            self._conversation.fail_asked(error)
            self._turn()

    def _wake_at(self, moment: float) -> None:
        if self._timer is not None:
            if self._timer_at <= moment + TIMER_SLACK:
                # It goes off early enough, and sets itself anew then.
                return
            self._timer.cancel()
        self._timer_at = moment
        self._timer = self._loop.call_later(moment - time.monotonic(), self._time_passed)

    def _time_passed(self) -> None:
        self._timer = None
        self._turn()

    def _end(self, error: LinkError) -> None:
        """The link is gone, and everybody hears of it at once."""
        if self._lost is None:
            self._lost = error
            self._link.close()
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        self._conversation.fail(self._lost)


def _wake(over: asyncio.Future[None]) -> None:
    if not over.done():
        over.set_result(None)


def _written(over: asyncio.Future[None], error: LinkError | None) -> None:
    if over.done():
        return
    if error is None:
        over.set_result(None)
    else:
        over.set_exception(error)
