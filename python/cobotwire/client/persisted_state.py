"""Remember what a session left on its port, for the next session on that port.

The next session may be in another process of the same user.

A reply can arrive after its session has ended. Without a note, the next session takes it for the
reply to its own first request of the same command. If a session wrote only half of a request, the
robot completes it with the first bytes of the next session. A session that ends in one of these
states leaves a note in this process, and in a file for other processes (``port_notes``). Most
sessions leave nothing and write no file. A client that is never closed leaves its note when it is
collected, or when the process exits. A process that is killed leaves no note.
"""

from __future__ import annotations

import atexit
import os
import time
from collections.abc import Callable
from contextlib import suppress
from weakref import WeakSet

from cobotwire.client.port_notes import LONGEST, MOST_ENTRIES, take_note, write_note
from cobotwire.session.outstanding import PersistedState
from cobotwire.transport import Transport
from cobotwire.transport.interface import OpenedTransport
from cobotwire.transport.timing import times_of

# The kinds of transport that lead to the same arm when they are opened again.
LASTING = ("serial", "socket", "rfc2217")
PSEUDO_TERMINALS = "/dev/pts/"


class PersistedSession:
    """The notes on one port.

    Only transports that lead to the same arm again have notes: serial ports and sockets, in real
    time. An open transport of the user's own has none, since its URL need not identify a port.
    """

    _persist: Callable[[float], PersistedState] | None = None

    def __init__(
        self, transport: Transport, persist: Callable[[float], PersistedState] | None = None
    ) -> None:
        """Find the notes of the port; ``persist`` returns what :meth:`end` leaves at a time."""
        same_again = (
            isinstance(transport, OpenedTransport)
            and transport.kind in LASTING
            and times_of(transport).real
        )
        self._keys = _keys(transport.url) if same_again else ()
        self._persist = persist
        if persist is not None:
            _sessions.add(self)

    def recall(self) -> PersistedState:
        """Return the notes on the port, and remove them."""
        nothing = PersistedState()
        found = [note for key in self._keys for note in (_here.pop(key, nothing), take_note(key))]
        now = time.monotonic()
        late = {late for note in found for late in note.late if now < late.until <= now + LONGEST}
        parts = {part for note in found for part in note.parts}
        return PersistedState(tuple(sorted(late, key=lambda late: late.until)), tuple(parts))

    def end(self) -> None:
        """Leave the note of the session, once; an ended session may have a successor."""
        if self._persist is not None:
            self.leave(self._persist(time.monotonic()))
            # Only now: a Ctrl-C before this line makes close() leave the note again.
            self._persist = None

    # The client was dropped without close(). References from here to the client are allowed, which
    # those of weakref.finalize are not: an exchange refers to errors, and their frames to a client.
    def __del__(self) -> None:
        self.end()

    def leave(self, state: PersistedState) -> None:
        """Leave a note on the port if a reply is outstanding or a request was cut."""
        if state.empty:
            return
        state = PersistedState(state.late[-MOST_ENTRIES:], state.parts[-MOST_ENTRIES:])
        for key in self._keys:
            _here[key] = state
            # Without a folder for notes, only this process remembers.
            with suppress(OSError):
                write_note(key, state)

    def leave_to_parent(self) -> None:
        """Leave no note from now on: after a fork the session is the parent's."""
        self._keys, self._persist = (), None


_here: dict[str, PersistedState] = {}
_sessions: WeakSet[PersistedSession] = WeakSet()


@atexit.register
def _end_all() -> None:
    for session in list(_sessions):
        session.end()


def _keys(url: str) -> tuple[str, ...]:
    """Return what identifies a port: its device, and a link that keeps its name after a replug."""
    if "://" in url:
        return (url,)
    device, link = os.path.realpath(url), os.path.abspath(url)
    links = (link,) if link != device else ()
    if device.startswith(PSEUDO_TERMINALS):
        # The system reuses the numbers of pseudo-terminals. The creation time tells them apart.
        with suppress(OSError):
            return f"{device} {os.stat(device).st_ctime_ns}", *links
    return device, *links
