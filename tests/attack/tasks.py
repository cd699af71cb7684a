"""Tasks that share one asyncio client."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from contextlib import suppress
from random import Random
from typing import Any

from attack.record import open_observed
from attack.setting import Setting
from cobotwire import LinkError


class SharedInLoop:
    """The client that the tasks share; after a break, one of them makes a new one."""

    def __init__(self, setting: Setting) -> None:
        self.setting = setting
        self.age = 0
        self.client: Any = None
        self._lock = asyncio.Lock()
        self._loop = asyncio.get_running_loop()

    async def restore(self, age: int) -> None:
        """Make a new client, unless that has been done since ``age``, or the run is over."""
        async with self._lock:
            if self.age != age or self.setting.over:
                return
            while not self.setting.over:
                with suppress(LinkError):
                    await self.client.close()
                    await self.open()
                    break
                await asyncio.sleep(0.01)
            self.age += 1

    async def open(self) -> None:
        """Make a client on a transport of its own."""
        setting = self.setting
        small = setting.plan.profile.stalls
        transport = open_observed(setting.url, setting.baudrate, setting.record, small=small)
        self.client = setting.client(transport, **setting.options)
        await self.client.open()

    def close(self) -> None:
        """Close it, called in another thread; calls end with an error."""
        closing = asyncio.run_coroutine_threadsafe(self.client.close(), self._loop)
        closing.result(5.0)


def run_tasks(
    setting: Setting, during: Callable[[SharedInLoop], None], settle: Callable[[], None]
) -> None:
    """Let the users of a run call until it is over.

    ``during`` does what else happens, and ends the run; ``settle`` waits for what was written
    before the client is closed.
    """
    asyncio.run(_run(setting, during, settle))


async def _run(
    setting: Setting, during: Callable[[SharedInLoop], None], settle: Callable[[], None]
) -> None:
    shared = SharedInLoop(setting)
    await shared.open()
    tasks = [asyncio.create_task(_user(shared, user)) for user in range(setting.plan.users)]
    loop = asyncio.get_running_loop()
    await loop.run_in_executor(None, during, shared)
    await asyncio.wait(tasks, timeout=setting.longest)
    setting.record.give_up()
    await loop.run_in_executor(None, settle)
    await shared.client.close()
    for task in tasks:
        task.cancel()
    await asyncio.wait(tasks, timeout=1.0)


async def _user(shared: SharedInLoop, user: int) -> None:
    setting = shared.setting
    random = Random(f"{setting.plan.seed} {user}")
    while not setting.over:
        age = shared.age
        began = time.monotonic()
        if not await _call(shared, user, random):
            if setting.plan.restores:
                await shared.restore(age)
            else:
                await asyncio.sleep(0.01)
        elif time.monotonic() - began < 0.0001:
            # A one-way request may end without a switch of tasks.
            await asyncio.sleep(0)


async def _call(shared: SharedInLoop, user: int, random: Random) -> bool:
    """Make one call and note how it ended; return False after a LinkError."""
    setting = shared.setting
    drawn = setting.draw(random)
    method = getattr(shared.client, drawn.name)
    options = {} if drawn.ack_within is None else {"ack_within": drawn.ack_within}
    call = setting.begin(user, drawn)
    task = asyncio.current_task()
    assert task is not None, "users are tasks"
    timer = None
    if setting.plan.profile.cancels and random.random() < 0.3:
        seconds = random.choice((0.0, 0.0005, 0.002, 0.02, 0.2)) * random.random()
        timer = asyncio.get_running_loop().call_later(seconds, task.cancel)
    try:
        value = await method(*drawn.arguments, **options)
    except BaseException as error:
        if isinstance(error, asyncio.CancelledError):
            task.uncancel()
        return setting.note_error(call, error)
    finally:
        if timer is not None:
            timer.cancel()
    setting.record.end(call, "value", value)
    return True
