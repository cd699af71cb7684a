"""The state that queries read, compared after each malformed request: nothing may change it.

Reading everything each time would take minutes. So after each malformed request one value is read,
in turn, and at the end all of them. If a value has changed, the requests since its last reading are
sent again, one by one, to find the one that changes it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from itertools import zip_longest
from typing import Any

from cobotwire.conformance.device.device import Device
from cobotwire.conformance.device.mover import give_power
from cobotwire.conformance.device.read_back import (
    SavedValue,
    Setting,
    fixed_effect,
    saved_value,
    settings_of,
)
from cobotwire.conformance.device.requests import arguments_of, gentle, values_text
from cobotwire.conformance.hex_text import shown
from cobotwire.protocol.messages import Reply, Request
from cobotwire.protocol.table import Command, Table

# How many other changed values a failure names.
MOST_NAMES = 12
# How often a run searches for the request that has changed something; a search takes seconds.
SEARCHES = 3


@dataclass(frozen=True, slots=True)
class Malformed:
    """A malformed request that was sent: its description and bytes; ``again`` sends it again."""

    what: str
    data: bytes
    again: Callable[[], object]

    def __str__(self) -> str:
        return f"{self.what} ({shown(self.data)})"


@dataclass(slots=True)
class _Kept:
    """A value that a query reads; ``set`` is the request that sets this value, if there is one.

    ``since`` holds the malformed requests that were sent since it was read last.
    """

    query: Request[Any]
    value: Reply[Any]
    set: Request[Any] | None = None
    since: list[Malformed] = field(default_factory=list)

    def __str__(self) -> str:
        return f"{self.query.command}({arguments_of(self.query)})"


class KeptState:
    """Everything that is set and can be read, in the order in which it is compared."""

    def __init__(self, device: Device) -> None:
        """Change each setting that the run may change, then read the state.

        A setting with its default value would hide that the device has returned to its defaults.
        """
        self._device = device
        self._marked: list[str] = []
        self._searches = 0
        if "power" in device.permissions.classes:
            give_power(device)
        self._values = [kept for query in _queries(device.table) for kept in self._read(query)]
        self._turn = 0
        # Whether the device finds the next frame after a malformed request without a pause, as far
        # as is known; and the kinds of malformed requests that were sent with pauses.
        self.resyncs = True
        self.tried_with_pauses: set[str] = set()

    def close(self) -> None:
        """Restore what was set; the next malformed request begins a new comparison."""
        for name in reversed(self._marked):
            restore = self._device.restore_at_end.pop(name, None)
            if restore is not None:
                restore()

    def next_query(self, other_than: int) -> Request[Any] | None:
        """Return the next query to compare, if any, with an id other than ``other_than``."""
        for _ in self._values:
            query = self._values[self._turn].query
            if self._device.table.command(query.command).id != other_than:
                return query
            self._turn = (self._turn + 1) % len(self._values)
        return None

    def check(self, sent: Malformed, reply: Reply[Any] | None = None) -> str:
        """Compare the next value in turn; return what has changed, empty if nothing has.

        ``reply`` is the reply to :meth:`next_query`; left out: the query is sent.
        """
        for kept in self._values:
            kept.since.append(sent)
        if not self._values:
            return ""
        kept = self._values[self._turn]
        self._turn = (self._turn + 1) % len(self._values)
        changed = self._compare(kept, reply)
        return changed and changed + self._also_changed(kept)

    def _also_changed(self, known: _Kept) -> str:
        """Compare the other values, which may have changed with the known one; name them."""
        names = []
        for kept in self._values:
            if kept is known:
                continue
            now = self._device.read(kept.query)
            if now is not None and now != kept.value:
                names.append(str(kept))
                self._set_again(kept)
            kept.since = []
        return f"; also changed: {', '.join(names[:MOST_NAMES])}" if names else ""

    def check_all(self) -> Iterator[str]:
        """Compare all values; yield what has changed."""
        for kept in self._values:
            changed = self._compare(kept)
            if changed:
                yield changed

    def _read(self, queries: list[tuple[Setting | None, Request[Any]]]) -> Iterator[_Kept]:
        for setting, query in queries:
            saved = saved_value(self._device, setting, query) if setting else None
            if setting is not None and saved is None:
                continue
            mark = None if saved is None else self._mark(saved)
            value = saved.before if saved and mark is None else self._device.read(query)
            if value is not None:
                yield _Kept(query, value, mark)

    def _mark(self, saved: SavedValue) -> Request[Any] | None:
        """Change a value that the run may set; return the request that changed it."""
        command = saved.setting.command
        if command.safety != "setting" or "setting" not in self._device.permissions.classes:
            return None
        if saved.obstacle or not saved.others:
            return None
        name = str(saved)
        self._device.restore_at_end[name] = partial(self._device.request, saved.old)
        self._marked.append(name)
        # The device may return to the plainest value instead of its default.
        plain = gentle(command)
        mark = next((each for each in saved.others if each != plain), saved.others[0])
        self._device.request(mark)
        return mark

    def _compare(self, kept: _Kept, reply: Reply[Any] | None = None) -> str:
        now = reply or self._device.read(kept.query)
        sent, kept.since = kept.since, []
        if now is None or now == kept.value:
            return ""
        change = f"expected {kept} to stay {values_text(kept.value)}; received {values_text(now)}"
        cause = self._find(kept, sent) if self._searches < SEARCHES else None
        self._searches += 1
        self._set_again(kept)
        if cause is not None:
            return f"after {cause}: {change}"
        return f"after one of {len(sent)} requests, from {sent[0]} to {sent[-1]}: {change}"

    def _find(self, kept: _Kept, sent: list[Malformed]) -> Malformed | None:
        """Send requests again, the last one first, until one changes the value."""
        for each in reversed(sent):
            if not self._set_again(kept):
                return sent[-1] if len(sent) == 1 else None
            each.again()
            if self._device.read(kept.query) != kept.value:
                return each
        return None

    def _set_again(self, kept: _Kept) -> bool:
        """Set a value again as the run has set it; return whether the device reports that value."""
        if kept.set is not None:
            self._device.request(kept.set)
        now = self._device.read(kept.query)
        if now == kept.value:
            return True
        if now is not None and kept.set is None:
            # The change is reported once: later values are compared with the new one.
            kept.value = now
        return False


def _queries(table: Table) -> list[list[tuple[Setting | None, Request[Any]]]]:
    """Return what to read: the first joint, pin or register of each query, then the second ones.

    State that a motion changes is left out. So is the error register, which a malformed request may
    set.
    """
    found: dict[Request[Any], Setting | None] = {}
    rows: dict[str, list[tuple[Setting | None, Request[Any]]]] = {}
    for command in table.commands:
        for setting, query in _read_by(table, command):
            if found.setdefault(query, setting) is setting:
                rows.setdefault(query.command, []).append((setting, query))
    turns = zip_longest(*rows.values())
    return [[each for each in turn if each is not None] for turn in turns]


def _read_by(table: Table, command: Command) -> Iterator[tuple[Setting | None, Request[Any]]]:
    back = command.read_by
    if back is None:
        return
    query = table.command(back.query)
    if query.role == "error" or query.text is not None:
        return
    if fixed_effect(table, command):
        if command.safety != "persistent write" and not query.request[0].fields:
            yield None, query.request_type()
    elif command.safety != "motion":
        for setting in settings_of(table, command):
            for each in setting.queries:
                yield setting, each
