"""Explore every order of a topic's events, breadth first: the first failure is the shortest.

A state that was seen is not explored again. A state is everything that a later decision can depend
on: each attribute of the exchange, with times relative to now, and the state of the World.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from itertools import chain
from math import inf
from typing import Any, NamedTuple
from unittest.mock import patch

from cobotwire.session import EncodedRequest, Pending
from cobotwire.session.received import ReceivedMeanwhile
from session.exploring.calls import Call
from session.exploring.promises import Broken
from session.exploring.topics import POLICY, Event, Topic
from session.exploring.world import LATEST, World

# Attributes that are not part of a state: they never change, or only an error's text shows them.
IGNORED = {
    *(
        "_codec",
        "_format",
        "_replying_ids",
        "_framer",
        "_on_done",
        "_received",
        "_error",
        "_fields",
    ),
    *("queued_at", "requested_at", "replied_at", "policy", "_variant", "pending"),
    # Attributes with the same value in all requests.
    *("_wait", "silence"),
}


class Path(NamedTuple):
    """A sequence of events."""

    before: Path | None
    event: Event

    @property
    def events(self) -> list[Event]:
        """All events in order."""
        return [*(self.before.events if self.before else ()), self.event]


class Search:
    """Explores sequences of events; ``found`` is the shortest one that breaks a promise."""

    def __init__(self, topic: Topic) -> None:
        self._topic = topic
        self.frontier: list[Path | None] = [None]
        self.seen: set[int] = set()
        self.depth = self.events = 0
        self.limits: Counter[str] = Counter()
        self.found = ""

    def deepen(self, most: float = inf, report: Callable[[], None] = lambda: None) -> None:
        """Explore sequences that are longer by one event, until ``most`` states were seen."""
        paths, self.frontier = self.frontier, []
        # Formatting the texts of errors would take longer than everything else together.
        with patch.object(ReceivedMeanwhile, "lines", lambda *_: ()):
            for path in paths:
                report()
                for event in list(self._replay(path).choices()):
                    self.events += 1
                    self._explore(Path(path, event))
                    if self.found or len(self.seen) >= most:
                        return
        self.depth += 1

    def __str__(self) -> str:
        met = ", ".join(f"{limit} {count:,}" for limit, count in sorted(self.limits.items()))
        counts = f"{len(self.seen):,} states, {self.events:,} events, depth {self.depth}"
        return f"{counts}; limits met: {met or 'none'}"

    def _replay(self, path: Path | None) -> World:
        world = World(self._topic)
        for event in path.events if path else ():
            world.do(event)
        return world

    def _explore(self, path: Path) -> None:
        then = ""
        try:
            world = self._replay(path.before)
            met = world.promises.limits.copy()
            world.do(path.event)
            self.limits += world.promises.limits - met
            state = hash(state_of(world))
            if state not in self.seen:
                self.seen.add(state)
                self.frontier.append(path)
                then = "; then time passes"
                run_out(world)
        except Broken as broken:
            steps = "; ".join(" ".join(event) for event in path.events)
            self.found = f"{broken}\n  after: {steps}{then}"


def run_out(world: World) -> None:
    """Let time pass until every call has ended; check that the next request is then sent."""
    world.next_write = "whole"
    last = world.waiting[-1].kind if world.waiting else "plain"
    for _ in range(12):
        if not world.waiting:
            break
        world.do(("pass",))
    else:
        raise Broken(f"{world.waiting[0].kind} never ends")
    world.now += POLICY.grace
    world.do(("call", last))
    if not world.calls[-1].writes:
        raise Broken(f"{last} is not sent, although no late reply can come any more")


def calls_of(world: World) -> list[Call]:
    """Return the calls on which later decisions depend."""
    needed = {reply.call for reply in world.replies} | set(world.waiting)
    return [
        call
        for call in world.calls
        if call in needed or (call.writes and world.now < call.writes[-1] + LATEST)
    ]


def state_of(world: World) -> tuple[object, ...]:
    """Return everything that later decisions depend on; the first item is the exchange."""
    now, fed, arm_fed = world.now, world.fed, world.arm.fed
    unparsed = world.exchange._framer.pending
    calls = calls_of(world)
    numbers = {id(call): number for number, call in enumerate(calls)}
    owners = {id(call.pending): number for number, call in enumerate(calls) if call.pending}

    def frozen(value: Any, name: str = "") -> object:
        if name == "offset":
            return max(value - fed + unparsed, 0)
        if type(value) is float:
            return max(value - now, -LATEST) if abs(value) < inf else value
        if value is None or isinstance(value, int | bytes | str):
            return value
        if isinstance(value, EncodedRequest):
            return value.frame
        if isinstance(value, Call):
            return numbers.get(id(value))
        if isinstance(value, Pending) and value.done:
            return None
        if isinstance(value, dict):
            value = value.items()
        if hasattr(value, "__iter__"):
            return tuple(frozen(each) for each in value)
        if type(value).__module__.startswith(("cobotwire.session", "session.exploring")):
            return (owners.get(id(value)), *inside(value))
        return True

    def inside(value: object) -> Iterator[object]:
        return (frozen(each, name) for name, each in _attributes(value))

    promises = world.promises
    return (
        frozen(world.exchange),
        *(tuple(inside(call)) for call in calls),
        frozen((world.replies, world.unread, world.next_write, promises.doubtful)),
        promises.echo_shown,
        tuple(sorted(arm_fed - at for at in promises.torn)),
        world.tail[len(world.tail) - unparsed :],
        world.arm.pending,
    )


def _attributes(value: object) -> Iterator[tuple[str, Any]]:
    slots = (getattr(cls, "__slots__", ()) for cls in type(value).__mro__)
    names = chain(getattr(value, "__dict__", ()), *slots)
    return ((name, getattr(value, name)) for name in names if name not in IGNORED)
