"""Threads that share one client.

The calls of an asyncio client are tasks of its loop; each thread waits for the end of its own.
"""

from __future__ import annotations

import _thread
import asyncio
import signal
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from random import Random
from types import FrameType
from typing import Any

from attack.calls import Drawn
from attack.record import open_observed
from attack.setting import Setting
from both_ways import InLoop
from cobotwire import LinkError

JOIN_SECONDS = 1.0


class Shared:
    """The client that the threads share; after a break, one of them opens it again."""

    def __init__(self, setting: Setting) -> None:
        self.setting = setting
        self.age = 0
        self._lock = threading.Lock()
        self._transport: Any = None
        self._loops: list[InLoop] = []
        self.client: Any = None
        self._open()

    def restore(self, age: int) -> None:
        """Reopen the client, unless another thread has since ``age``, or the run is over."""
        with self._lock:
            if self.age != age or self.setting.over:
                return
            plan = self.setting.plan
            while not self.setting.over:
                with suppress(LinkError):
                    if plan.reopens:
                        self._transport.reopen()
                    else:
                        self.close()
                        self._open()
                    break
                time.sleep(0.01)
            self.age += 1

    def close(self) -> None:
        """Close the client; calls in other threads end with an error."""
        self.client.close()

    def end(self) -> None:
        """End the loops of asyncio clients, or the client's process, after the last call."""
        for loop in self._loops:
            loop.end()
        if self.setting.plan.apart:
            self.client.end()

    @property
    def transport_is_closed(self) -> bool:
        """Whether the transport that was opened last is closed."""
        closed: bool = self._transport._closed
        return closed

    def _open(self) -> None:
        setting = self.setting
        if setting.plan.apart:
            if self.client is None:
                self.client = self._transport = setting.client()
            else:
                self.client.open()
            return
        small = setting.plan.profile.stalls
        self._transport = open_observed(setting.url, setting.baudrate, setting.record, small=small)
        if setting.plan.client == "blocking":
            self.client = setting.client(self._transport, **setting.options)
        else:
            self.client = InLoop(setting.client, self._transport, **setting.options)
            self._loops.append(self.client)


class Interrupts:
    """Raises Ctrl-C in the main thread at random times, while a call runs there.

    Attributes:
        armed: whether a call runs that may be interrupted.
        raised: the number of interrupts.
    """

    def __init__(self, random: Random, signals: bool) -> None:
        self.armed = False
        self.raised = 0
        self._random = random
        self._strike = _signal_main if signals else _thread.interrupt_main
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._interrupt, daemon=True)

    def __enter__(self) -> Interrupts:
        self._before = signal.signal(signal.SIGINT, self._handle)
        self._thread.start()
        return self

    def __exit__(self, *raised: object) -> None:
        self._over.set()
        self._thread.join()
        signal.signal(signal.SIGINT, self._before)

    def _handle(self, number: int, frame: FrameType | None) -> None:
        if self.armed:
            self.armed = False
            self.raised += 1
            raise KeyboardInterrupt

    def _interrupt(self) -> None:
        while not self._over.wait(self._random.expovariate(1 / 0.004)):
            if self.armed:
                self._strike()


def run_threads(
    setting: Setting, during: Callable[[Shared], None], settle: Callable[[], None]
) -> None:
    """Run the users' calls until the run is over.

    ``during`` breaks, stalls or closes the line and ends the run; ``settle`` waits for written
    bytes before the client is closed.
    """
    shared = Shared(setting)
    plan = setting.plan
    first = 1 if plan.profile.interrupts else 0
    threads = [
        threading.Thread(target=_user, args=(shared, user), daemon=True)
        for user in range(first, plan.users)
    ]
    happening = threading.Thread(target=during, args=(shared,), daemon=True)
    for thread in (*threads, happening):
        thread.start()
    if plan.profile.interrupts:
        random = Random(f"{plan.seed} interrupts")
        with Interrupts(random, plan.profile.signals) as interrupts:
            if plan.profile.signals:
                _end_block(shared, random, interrupts)
            else:
                _user(shared, 0, interrupts)
    happening.join()
    until = time.monotonic() + setting.longest
    for thread in threads:
        thread.join(max(0.0, until - time.monotonic()))
    setting.record.give_up()
    settle()
    shared.close()
    for thread in threads:
        thread.join(JOIN_SECONDS)
    shared.end()


def _signal_main() -> None:
    main = threading.main_thread().ident
    assert main is not None, "the main thread runs"
    signal.pthread_kill(main, signal.SIGINT)


def _end_block(shared: Shared, random: Random, interrupts: Interrupts) -> None:
    """Call in a ``with`` block until a signal ends it; the client must then send stop once.

    Other threads call meanwhile, and afterwards on the closed client.
    """
    setting, last = shared.setting, random.randint(1, 5)
    with suppress(KeyboardInterrupt), shared.client:
        while interrupts.raised < last and not setting.over:
            _call(shared, 0, random, interrupts)
        stop = setting.begin(0, Drawn("stop", (), None))
        raise KeyboardInterrupt
    closed = shared.transport_is_closed
    setting.record.end(stop, *(("value", None) if closed else ("exception", "the port is open")))


def _user(shared: Shared, user: int, interrupts: Interrupts | None = None) -> None:
    setting = shared.setting
    random = Random(f"{setting.plan.seed} {user}")
    while not setting.over:
        age = shared.age
        if not _call(shared, user, random, interrupts):
            # A broken line is opened again; one that only stalls is used as it is.
            if setting.plan.restores:
                shared.restore(age)
            else:
                time.sleep(0.01)


def _call(shared: Shared, user: int, random: Random, interrupts: Interrupts | None) -> bool:
    """Make one call and note how it ended; return False after a LinkError."""
    setting = shared.setting
    drawn = setting.draw(random)
    method = getattr(shared.client, drawn.name)
    options = {} if drawn.ack_within is None else {"ack_within": drawn.ack_within}
    if setting.plan.profile.cancels and random.random() < 0.3:
        seconds = random.choice((0.0, 0.0005, 0.002, 0.02, 0.2)) * random.random()
        if setting.plan.apart:
            method = shared.client.cancelled_after(seconds, drawn.name)
        else:
            method = _cancelled_after(seconds, shared.client, drawn.name)
    call = setting.begin(user, drawn)
    try:
        try:
            if interrupts is not None:
                interrupts.armed = True
            value = method(*drawn.arguments, **options)
        finally:
            if interrupts is not None:
                interrupts.armed = False
    except BaseException as error:
        return setting.note_error(call, error)
    setting.record.end(call, "value", value)
    return True


def _cancelled_after(seconds: float, arm: InLoop, name: str) -> Callable[..., Any]:
    """Return a method of an asyncio client whose task is cancelled after some seconds."""

    async def call(*arguments: Any, **options: Any) -> Any:
        task = asyncio.current_task()
        assert task is not None, "the loop runs each call as a task"
        timer = asyncio.get_running_loop().call_later(seconds, task.cancel)
        try:
            return await getattr(arm.client, name)(*arguments, **options)
        finally:
            timer.cancel()

    return lambda *arguments, **options: arm.run(call(*arguments, **options))
