"""Determine the outcome of each call of a run from the records of the arm and of the users."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import Counter
from collections.abc import Iterable
from itertools import chain
from typing import NamedTuple

from attack.arm import HostilePeer, Made
from attack.evidence import Evidence
from attack.line import HostileLine
from attack.record import Call
from attack.setting import Setting
from attack.tally import Tally
from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import ProtocolError
from cobotwire.session.exchange import DRAIN_SECONDS
from cobotwire.transport.descriptor import WRITE_SECONDS

# How much later than its deadline a call may end.
LATE_SECONDS = 0.1
MOST_FAILURES = 4


class Scene(NamedTuple):
    """The records of a run.

    Attributes:
        setting: the plan and the record of the users.
        line: what arrived and what was delivered.
        peer: what the arm received and sent.
        stalls: for each meter, when the machine stalled, and for how many seconds.
    """

    setting: Setting
    line: HostileLine
    peer: HostilePeer
    stalls: list[list[tuple[float, float]]]


class Validator:
    """Validates one run."""

    def __init__(self, scene: Scene) -> None:
        self.tally = Tally(scene.setting.plan.profile.name)
        self._scene = scene
        self._plan = scene.setting.plan
        self._codec: Codec = scene.setting.codec
        self._calls = sorted(scene.setting.record.calls, key=lambda call: call.number)
        self._made: dict[bytes, list[Made]] = {}
        for made in scene.peer.arm.made:
            self._made.setdefault(made.request, []).append(made)
        self._arrived: dict[bytes, list[float]] = {}
        for at, request in scene.peer.arm.received:
            self._arrived.setdefault(request, []).append(at)
        self._of_request: dict[bytes, list[Call]] = {}
        for call in self._calls:
            self._of_request.setdefault(call.request, []).append(call)
        self._evidence = Evidence(
            self._codec,
            scene.peer.outlet.sent,
            scene.line.delivered,
            scene.setting.record,
            scene.setting.plan.grace,
        )
        self._fails = 0

    def validate(self) -> Tally:
        """Return the counts of the run, and its failures in words."""
        for call in sorted(self._calls, key=lambda call: call.ended):
            self.tally.counts["calls"] += 1
            self._validate_call(call)
        self._validate_frames()
        return self.tally

    def _validate_call(self, call: Call) -> None:
        counts = self.tally.counts
        if call.ending == "lost":
            counts["lost"] += 1
            self._fail(call, "lost: it never ended")
            return
        if call.ending == "error":
            counts["honest"] += 1
        elif call.ending == "interrupted":
            counts["interrupted"] += 1
        elif call.ending == "exception":
            counts["exceptions"] += 1
            self._fail(call, "an exception of an undocumented type")
        elif self._is_right(call):
            counts["right"] += 1
        else:
            self._validate_wrong(call)
        self._validate_time(call)

    def _is_right(self, call: Call) -> bool:
        """Return whether the arm replied to the call's request with this value during the call."""
        if call.query:
            return any(
                made.value == call.value
                and not made.damaged
                and call.began <= made.at <= call.ended
                for made in self._made.get(call.request, ())
            )
        if call.ack_within is None:
            return True
        times = self._arrived.get(call.request, [])
        index = bisect_left(times, call.began)
        return index < len(times) and times[index] <= call.ended

    def _validate_wrong(self, call: Call) -> None:
        limit = self._evidence.limit_of(call, self._plan.restores)
        if limit:
            self.tally.limits[limit] += 1
            self.tally.counts["limited"] += 1
            return
        self.tally.counts["wrong"] += 1
        self._fail(call, "silently wrong", *self._evidence.explain(call))

    def _validate_time(self, call: Call) -> None:
        due, deadline = self._due(call), self._plan.deadline
        if deadline is not None:
            due = min(due, call.began + deadline + LATE_SECONDS)
        if call.ended <= due or call.ending == "interrupted":
            return
        excess = call.ended - due
        stalled = _stalled(call, chain.from_iterable(self._scene.stalls))
        if stalled >= excess:
            self.tally.counts["stalled"] += 1
            return
        self.tally.counts["late"] += 1
        self._fail(call, f"late by {excess:.3f} s; the machine stalled for {stalled:.3f} s")

    def _due(self, call: Call) -> float:
        """Return when a call must have ended: counted from its write, if that time is certain."""
        handed = self._evidence.handed_at(call)
        alike = self._of_request[call.request]
        uncontended = sum(c.began <= call.ended and call.began <= c.ended for c in alike) == 1
        if handed is None or not uncontended:
            return call.began + self._scene.setting.longest
        written = self._evidence.written_at(call, handed)
        if written is None:
            return handed + WRITE_SECONDS + DRAIN_SECONDS + LATE_SECONDS
        wait = self._plan.timeout if call.query else call.ack_within or DRAIN_SECONDS
        return written + wait + LATE_SECONDS

    def _validate_frames(self) -> None:
        """Compare the requests that arrived with those that users called for."""
        legal = [frame for _, frame in self._scene.line.frames if self._is_legal(frame)]
        arrived = Counter(legal)
        called = Counter(call.request for call in self._calls)
        safe = Counter(
            call.request for call in self._calls if not call.query and call.ending == "value"
        )
        for frame, count in arrived.items():
            if frame not in called:
                self.tally.counts["merged"] += count
                self._fail_frame(frame, f"{count} times at the arm, and no call sent it")
            elif self._moves(frame) and count > called[frame]:
                self.tally.counts["duplicates"] += count - called[frame]
                self._fail_frame(frame, f"{count} times at the arm for {called[frame]} calls")
        if self._plan.restores:
            return
        for frame, count in safe.items():
            if arrived[frame] < count:
                self.tally.counts["wrong"] += count - arrived[frame]
                text = f"{arrived[frame]} times at the arm for {count} calls without an error"
                self._fail_frame(frame, text)

    def _is_legal(self, frame: bytes) -> bool:
        try:
            self._codec.decode("request", frame)
        except ProtocolError:
            return False
        return True

    def _moves(self, frame: bytes) -> bool:
        return self._codec.decode("request", frame).command.safety != "query"

    def _fail(self, call: Call, reason: str, *more: str) -> None:
        index = bisect_right([c.number for c in self._calls], call.number)
        near = self._calls[max(0, index - 6) : index + 3]
        around = [f"{'>>' if c is call else '  '} {c}" for c in near]
        self._note(f"{reason}: {call}", [*more, *around])

    def _fail_frame(self, frame: bytes, reason: str) -> None:
        times = [at for at, arrived in self._scene.line.frames if arrived == frame]
        near = [
            c
            for c in self._calls
            if times and c.began <= times[0] + 0.1 and c.ended >= times[0] - 2
        ]
        self._note(
            f"{frame.hex(' ').upper()} {reason}, at {times[:4]}", [str(c) for c in near[-8:]]
        )

    def _note(self, title: str, lines: list[str]) -> None:
        self._fails += 1
        if self._fails <= MOST_FAILURES:
            self.tally.failures.append("\n".join([str(self._plan), title, *lines]))


def _stalled(call: Call, stalls: Iterable[tuple[float, float]]) -> float:
    """Return for how many seconds of a call a thread or processor was stalled.

    A call waits for several threads in turn, so stalls of different threads add up; a time at which
    two were stalled counts once.
    """
    total, counted = 0.0, call.began
    for start, end in sorted((at - seconds, at) for at, seconds in stalls):
        start, end = max(start, counted), min(end, call.ended)
        if start < end:
            total, counted = total + end - start, end
    return total
