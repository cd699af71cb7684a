"""Explore every order of events in Python and in Rust, whose states must be the same."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import patch

from session.exploring import explorer
from session.exploring.explorer import Path as Events
from session.exploring.explorer import Search, calls_of, state_of
from session.exploring.topics import CODEC, Topic
from session.exploring.world import LATEST, World
from session.twins import Recorder
from vectors import ROOT

# Attributes that never change, or that only an outcome shows; times; positions in the stream.
LEFT_OUT = re.compile(
    r"queued_at: \d+, |requested_at: \d+, |policy: RetryPolicy {[^}]*}, "
    r"|received: \[.*?\], (?=policy: )"
)
TIMES = "until|ends_by|deadline|undrained_since|sent_at|last|began_at|attempt_times|doubts"
TIME = re.compile(rf"\b({TIMES}): (Some\(|\[)?([\d, ]+)")
OFFSET = re.compile(r"\boffset: (\d+)")
TICKET = re.compile(r"ticket: Ticket\((\d+)\)")
NEVER = (1 << 64) - 1


def edition(folder: Path) -> str:
    """Write the ``edition.json`` of what is explored; return its path."""
    documents = {
        name: json.loads((ROOT / f"python/cobotwire/editions/{name}/edition.json").read_text())
        for name in ("mycobot280", "mycobot", "pro400")
    }
    commands = {
        (name, command["name"]): command
        for name, document in documents.items()
        for command in document["commands"]
    }
    own = {"get_digital_input": "mycobot", "motion_ended": "pro400"}
    found = [commands[own.get(c.name, "mycobot280"), c.name] for c in CODEC.table.commands]
    document = {**documents["mycobot280"], "commands": [{**c, "role": ""} for c in found]}
    for part in ("wires", "types"):
        own = {record["name"]: record for each in documents.values() for record in each[part]}
        document[part] = [*(own | {r["name"]: r for r in document[part]}).values()]
    path = folder / "edition.json"
    path.write_text(json.dumps(document))
    return str(path)


class TwinSearch(Search):
    """A search that has Rust repeat each sequence of events, and compares the states."""

    def __init__(self, topic: Topic, path: str, ask: Callable[[Any], Any]) -> None:
        """Take the path of the edition, and a function that sends the probe a question."""
        super().__init__(topic)
        self._path, self._ask = path, ask
        self._twins: dict[int, int] = {}
        self._states: set[int] = set()

    def _explore(self, path: Events) -> None:
        noted: list[tuple[tuple[object, ...], list[int | None], float]] = []

        def note(world: World) -> tuple[object, ...]:
            state, calls = state_of(world), calls_of(world)
            numbers = {id(call.pending): number for number, call in enumerate(calls)}
            twin = recorder.note_state(world.exchange)
            owners = [numbers.get(id(pending)) for pending in twin.pending]
            noted.append((state, owners, world.now))
            return state

        with Recorder(self._path) as recorder, patch.object(explorer, "state_of", note):
            super()._explore(path)
        described = recorder.check(self._ask)
        for (state, owners, now), text in zip(noted, described, strict=True):
            own = hash((canonical(text, owners, now), *state[1:]))
            assert self._twins.setdefault(hash(state), own) == own, path.events
            self._states.add(own)
        assert len(self._states) == len(self._twins), path.events


def canonical(text: str, owners: list[int | None], now: float) -> str:
    """Return a state with times and positions relative to now."""
    at = round(now * 1e9)
    least = round(-LATEST * 1e9)
    fed, unparsed = (int(number) for number in re.findall(r"(?:fed|unparsed): (\d+)", text)[:2])

    def relative(found: re.Match[str]) -> str:
        times = [int(time) for time in re.findall(r"\d+", found[3])]
        return f"{found[1]}: {[time if time == NEVER else max(time - at, least) for time in times]}"

    text = LEFT_OUT.sub("", text.partition("unparsed: ")[2])
    text = TIME.sub(relative, text)
    text = OFFSET.sub(lambda found: f"offset: {max(int(found[1]) - fed + unparsed, 0)}", text)
    return TICKET.sub(lambda found: f"owner: {owners[int(found[1]) - 1]}", text)
