"""Select, queue and handle the events that a client receives."""

from __future__ import annotations

import sys
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any, Generic, TypeVar

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.messages import Event
from cobotwire.protocol.table import Address, Table
from cobotwire.session import AckReceived, EventReceived, Traffic

EventT = TypeVar("EventT", bound=Event)

# The default number of events that are queued while the consumer is busy.
CAPACITY = 1000


# ``inspect.CO_COROUTINE``; importing ``inspect`` would add a fifth to the import time of a client.
_COROUTINE = 0x80


class Wanted:
    """The events that a stream or a handler wants."""

    def __init__(
        self, table: Table, types: tuple[type[Event], ...], address: Address | None
    ) -> None:
        """Select events by class, all if ``types`` is empty, and by the address of the client.

        Raises:
            UsageError: a type is not an event of the edition, or the edition has no events.
        """
        known = [command.name for command in table.commands if command.event]
        if not known:
            message = f"edition {table.edition} has no events"
            raise UsageError("events", message=message)
        for type in types:
            if getattr(type, "command", None) not in known:
                raise UsageError("events", type, f"events of the edition: {', '.join(known)}")
        self._names = frozenset(type.command for type in types) or frozenset(known)
        # An address that stands for several devices receives the events of all of them.
        self._address = address.value if address and address.replies == "own" else None

    def event_of(self, traffic: Traffic) -> Event | None:
        """Return the received event; None if it is not a wanted event."""
        found = traffic.event
        if not isinstance(found, EventReceived) or found.command.name not in self._names:
            return None
        if self._address is not None and found.message.address != self._address:
            return None
        event: Any = found.message.typed
        return event  # type: ignore[no-any-return]  # the reply of an event command is an Event


class EventQueue:
    """Events that wait for their consumer; a full queue drops the oldest and counts it.

    Attributes:
        lost: how many were dropped.
    """

    def __init__(self, wanted: Wanted, capacity: int) -> None:
        """Keep at most ``capacity`` events.

        Raises:
            UsageError: the capacity is not a positive whole number.
        """
        if not isinstance(capacity, int) or isinstance(capacity, bool) or capacity < 1:
            raise UsageError("capacity", capacity, "a whole number above 0")
        self._wanted = wanted
        self._waiting: deque[Event] = deque()
        self._capacity = capacity
        self.lost = 0

    def take(self, traffic: Traffic) -> None:
        """Queue the received event if it is a wanted one."""
        event = self._wanted.event_of(traffic)
        if event is None:
            return
        if len(self._waiting) >= self._capacity:
            self._waiting.popleft()
            self.lost += 1
        self._waiting.append(event)

    def next(self) -> Any:
        """Return the oldest event; None if the queue is empty."""
        try:
            return self._waiting.popleft()
        except IndexError:
            return None

    @property
    def filled(self) -> bool:
        """Whether an event waits."""
        return bool(self._waiting)


class EndSigns:
    """Collects messages of a device that can mean the end of a motion.

    Attributes:
        acked: whether an acknowledgement of a motion waits for :meth:`next` to return it.
        queue: the events of ended motions; None if the edition has no such event.
    """

    def __init__(self, table: Table, address: Address | None) -> None:
        command = table.find_role("motion ended")
        self.acked = False
        self.queue: EventQueue | None = None
        if command is not None:
            event: Any = command.reply_type
            self.queue = EventQueue(Wanted(table, (event,), address), CAPACITY)

    def take(self, traffic: Traffic) -> None:
        """Note what was received if it can mean the end."""
        found = traffic.event
        if isinstance(found, AckReceived) and found.command.safety == "motion":
            self.acked = True
        if self.queue is not None:
            self.queue.take(traffic)

    @property
    def received(self) -> bool:
        """Whether something waits."""
        return self.acked or (self.queue is not None and self.queue.filled)

    def next(self) -> Any:
        """Return the oldest event, or True for an acknowledgement; None: nothing waits."""
        event = None if self.queue is None else self.queue.next()
        if event is None and self.acked:
            self.acked, event = False, True
        return event


@contextmanager
def end_signs(
    table: Table,
    address: Address | None,
    add: Callable[[Callable[[Traffic], None]], Callable[[], None]],
) -> Iterator[EndSigns]:
    """Yield a collector of the signs of a motion's end.

    ``add`` adds a traffic listener, and returns a function that removes it.
    """
    signs = EndSigns(table, address)
    remove = add(signs.take)
    try:
        yield signs
    finally:
        remove()


class EventHandler(Generic[EventT]):
    """A function that is called with each event; see :meth:`cobotwire.client.Client.on`.

    Attributes:
        failures: how often the function has raised an error.
        error: the last of these errors.
    """

    def __init__(self, wanted: Wanted, handler: Callable[[EventT], object]) -> None:
        if not callable(handler) or _is_coroutine_function(handler):
            raise UsageError("handler", handler, "a function, not a coroutine: use events() there")
        self._wanted, self._handler = wanted, handler
        self._remove: Callable[[], None] | None = None
        self.failures = 0
        self.error: Exception | None = None

    def start(self, add: Callable[[Callable[[Traffic], None]], Callable[[], None]]) -> None:
        """Start calling the function, from a traffic listener."""
        self._remove = add(self._take)

    def remove(self) -> None:
        """Stop calling the function. Removing twice is harmless."""
        if self._remove is not None:
            self._remove()
            self._remove = None

    def _take(self, traffic: Traffic) -> None:
        event: Any = self._wanted.event_of(traffic)
        if event is None:
            return
        try:
            self._handler(event)
        except Exception as error:
            # The call that read the event did not cause the error, so it must not raise it.
            self.failures += 1
            self.error = error
            sys.excepthook(type(error), error, error.__traceback__)


def _is_coroutine_function(handler: object) -> bool:
    while isinstance(handler, partial):
        handler = handler.func
    code = getattr(handler, "__code__", None)
    return bool(getattr(code, "co_flags", 0) & _COROUTINE)
