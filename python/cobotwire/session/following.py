"""Follow a path or a live source of targets: what to send, and when; times are numbers.

A generator yields each step and receives its outcome, as in :mod:`cobotwire.session.motion`.

The arm must be in its mode in which a new target replaces the old one (*fresh* mode). A setpoint is
sent when its tick begins; if the process or the line is late by a tick, the setpoints in between
are dropped. After a longer stall the rest of the path is given up, since the arm would catch up
with a jump.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Generator, Sequence
from contextlib import suppress
from typing import Any, NoReturn

from cobotwire.kinematics import geometry_of
from cobotwire.kinematics.coordinates import indices_of
from cobotwire.kinematics.curve import Point
from cobotwire.kinematics.jerk_limited import Bounds, load_ruckig
from cobotwire.protocol.effects import ends_motion, fresh_mode
from cobotwire.protocol.errors import FollowFailed, UsageError
from cobotwire.protocol.fields import named_fields
from cobotwire.protocol.limits import joint_limits
from cobotwire.protocol.messages import Request
from cobotwire.protocol.roles import row_index, targets_request
from cobotwire.protocol.table import Command, Table
from cobotwire.session.motion import TOLERANCES, Outcome, Query
from cobotwire.session.paths import (
    Ended,
    FollowReport,
    PathLimits,
    Pause,
    Send,
    Source,
    Target,
    Waypoint,
)
from cobotwire.session.request import EncodedRequest
from cobotwire.session.setpoints import Interpolation, Live, OnLines, Path, evenly

# Setpoints a second, if the line carries them.
USUAL_RATE, HIGHEST_RATE = 50.0, 500.0
# The largest share of a tick that a reply may take.
BUSY_SHARE = 0.8
# The seconds between two readings of the joints during the motion.
FEEDBACK_SECONDS = 0.2
# The number of queries before the motion. The shortest of their times is the time of a reply.
TIMED_QUERIES = 3
# With fewer setpoints a second an arm stops at each.
LEAST_RATE = 5.0
# The longest stall of the process; after a longer one the rest of the path is given up.
STALL_SECONDS = 0.5
# An arm that stands still for this long at the end of the path does not continue by itself.
STILL_SECONDS = 1.0
READING_SECONDS = 0.1
# The arm lags behind its setpoints, so each is sent with the highest speed of the last second.
LAG_SECONDS = 1.0
# The limits of an arm whose edition states none: degrees a second for each percent of speed, and
# degrees per second squared. A joint is at its full acceleration after JERK_SECONDS.
UNSTATED_SPEED, UNSTATED_ACCELERATION, JERK_SECONDS = 1.0, 60.0, 0.1
# The path uses this share of the acceleration; the arm needs the rest to catch up.
SHARE_OF_ACCELERATION = 0.5
# If the arm reports its flange further than this from where its angles put it, it has a tool or
# another frame of reference.
FRAME_MILLIMETRES = 10.0

Step = Query | Pause | Send
Steps = Generator[Step, Outcome, None]


class Follow:
    """One call of ``follow``: its arguments, its steps and its report.

    Attributes:
        moving: whether a setpoint was sent, so that an error has to stop the arm.
        restore: the request that restores the arm's mode; None: nothing to restore.
    """

    def __init__(
        self,
        table: Table,
        encode: Callable[[Request[Any]], EncodedRequest],
        baudrate: int,
        path: Sequence[Any] | Source,
        *,
        speed: int,
        rate: float | None,
        coords: bool,
        limits: PathLimits | None,
        silence: float | None,
        timeout: float,
    ) -> None:
        """Check the arguments.

        Raises:
            UsageError: an argument is not allowed, or the edition cannot follow a path.
        """
        load_ruckig()
        self._table, self._encode, self._baudrate = table, encode, baudrate
        self._silence, self._timeout = silence, timeout
        self._command = table.in_role("joint targets")
        self._where = table.in_role("joints").request_type()
        variant = self._command.request[0]
        self._joints = len(variant.fields[row_index(variant)].cases[0].numbers)
        if not isinstance(speed, int) or not 1 <= speed <= 100:
            raise UsageError("speed", speed, "a whole number 1..100 percent")
        self._speed, self._rate = speed, _checked_rate(rate)
        self._fresh = fresh_mode(table)
        motion = table.robot.motion
        self._percent = motion.speed if motion else UNSTATED_SPEED
        fastest = motion.fastest if motion else math.inf
        self._bounds = _bounds(
            PathLimits() if limits is None else limits,
            min(speed * self._percent, fastest),
            motion.acceleration * SHARE_OF_ACCELERATION if motion else UNSTATED_ACCELERATION,
            self._joints,
        )
        self._lines = _on_lines(table) if coords else None
        self._target = table.in_role("coordinate targets") if coords else self._command
        self._interpolate: Interpolation = self._lines or evenly
        self._source = path if isinstance(path, Source) else None
        self._waypoints = [] if isinstance(path, Source) else self._checked_path(path)
        self.moving = False
        # The command by which another part of the program ended the motion.
        self._stopped_by = ""
        self._ending = {each.name for each in table.commands if ends_motion(table, each)}
        self.restore: EncodedRequest | None = None
        self._sent = self._dropped = self._superseded = 0
        self._deviation: float | None = None
        self._began = self._sent_at = self._now = 0.0
        self._period = 0.0
        self._setpoint: Point = ()

    def note_sent(self, command: Command) -> None:
        """Take note of a command that was sent to any address; one that ends motions ends this one.

        It may be called from any thread.
        """
        if command.name in self._ending:
            self._stopped_by = command.name

    def report(self, ended: Ended = "end") -> FollowReport:
        """Return the report on the motion so far."""
        sending = self._sent_at - self._began
        return FollowReport(
            ended,
            self._sent / sending if sending else 0.0,
            self._sent,
            self._dropped,
            self._superseded,
            self._deviation,
            self._now - self._began,
        )

    def steps(self, now: float) -> Steps:
        """Yield the steps of following the path.

        Raises:
            UsageError: a target is not allowed; if it is one of a path, only queries were sent.
            FollowFailed: the source was silent, the process stalled, or the arm stopped short.
        """
        self._now = self._began = now
        start, reply_seconds = yield from self._start()
        # Ten bits a byte. An acknowledgement is no longer than the request.
        wire_seconds = 10 * len(self._encoded(start, self._speed).frame) / self._baudrate
        rate = min(self._rate, BUSY_SHARE / max(wire_seconds, reply_seconds))
        if rate < min(self._rate, LEAST_RATE):
            message = (
                f"a reply of the arm takes {reply_seconds:.2f} s; for smooth motion it has to take "
                f"{rate / LEAST_RATE * reply_seconds:.2f} s at most"
            )
            raise UsageError("path", message=message)
        self._period = 1 / rate
        plan = self._plan(start, rate)
        yield from self._make_fresh()
        self._began = self._sent_at = self._now
        yield from self._run(plan, reply_seconds)
        if self.moving:
            yield from self._arrive(plan.end)

    def _start(self) -> Generator[Step, Outcome, tuple[Point, float]]:
        """Read where the joints are, and how long a reply takes."""
        durations = []
        for _ in range(TIMED_QUERIES):
            before = self._now
            found = yield from self._query(self._where)
            durations.append(self._now - before)
        start = tuple(map(float, found))
        if self._lines is not None:
            yield from self._check_frame(start, self._lines)
        return start, min(durations)

    def _query(
        self, request: Request[Any], longest: float = math.inf
    ) -> Generator[Step, Outcome, Any]:
        self._now, result = yield Query(request, longest)
        return result

    def _check_frame(self, start: Point, lines: OnLines) -> Steps:
        """Check that the arm reports the coordinates of its flange."""
        query = self._table.find_role("coordinates")
        if query is None:
            return
        reported = yield from self._query(query.request_type())
        away = math.dist(lines.coords_at(start)[:3], reported[:3])
        if away > FRAME_MILLIMETRES:
            message = (
                f"coords: the arm reports a position {away:.0f} mm from its flange, so it has a "
                "tool or another frame of reference; straight lines are those of the flange"
            )
            raise UsageError("coords", message=message)

    def _plan(self, start: Point, rate: float) -> Path | Live:
        if self._source is not None:
            return Live(start, self._interpolate, self._bounds, rate)
        path = Path(start, self._waypoints, self._interpolate, self._bounds, rate)
        for tick in range(1, path.ticks + 1):
            try:
                self._encoded(path.at(tick)[0], self._speed)
            except UsageError as error:
                when = f"the path leaves the limits after {tick / rate:.2f} s: {error}"
                raise UsageError("path", message=when) from None
        return path

    def _make_fresh(self) -> Steps:
        """Let new targets replace old ones; keep the request that restores the mode."""
        setting, argument, query = self._fresh
        fresh, usual = (setting.request_type(**{argument: mode}) for mode in (1, 0))
        if query is not None and (yield from self._query(query.request_type())):
            return
        self.restore = self._encode(usual)
        self._now, _ = yield Send(self._encode(fresh))
        if query is not None and not (yield from self._query(query.request_type())):
            message = f"the arm ignores {fresh.command}(): it would queue the targets of a path"
            raise UsageError("path", message=message)

    def _run(self, plan: Path | Live, reply_seconds: float) -> Steps:
        """Send the setpoints, each when its tick begins."""
        speeds: deque[float] = deque(maxlen=max(1, round(LAG_SECONDS / self._period)))
        every = max(1, round(FEEDBACK_SECONDS / self._period))
        began, tick = self._now, 0
        self._received_at = began
        while True:
            self._take_targets(plan)
            if plan.done and (self._source is None or self._source.exhausted):
                return
            self._now, _ = yield Pause(began + (tick + 1) * self._period)
            self._check_stopped()
            late = self._now - (began + (tick + 1) * self._period)
            if late > STALL_SECONDS:
                self._fail("stall", f"the program stalled for {late:.1f} s")
            passed = 1 + max(0, math.floor(late / self._period + 1e-6))
            if isinstance(plan, Path):
                passed = min(passed, plan.ticks - tick)
            tick += passed
            self._setpoint, pace = plan.step(passed)
            if isinstance(plan, Live) and not plan.moves:
                continue
            self._dropped += passed - 1
            speeds.append(pace)
            percent = min(self._speed, max(1, math.ceil(max(speeds) / self._percent)))
            request = self._encoded(self._setpoint, percent)
            self.moving = True
            self._now, _ = yield Send(request)
            self._sent, self._sent_at = self._sent + 1, self._now
            if tick % every == 0:
                left = began + (tick + 1) * self._period - self._now
                if left > reply_seconds:
                    yield from self._compare(left)

    def _take_targets(self, plan: Path | Live) -> None:
        """Take the newest target of a live source."""
        if self._source is None or self._source.exhausted or isinstance(plan, Path):
            return
        targets = self._source.take()
        if targets:
            self._superseded += len(targets) - 1
            self._received_at = self._now
            plan.take(self._checked("target", targets[-1]), self._now)
        elif not self._source.exhausted and self._silence is not None:
            silent = self._now - self._received_at
            if silent >= self._silence:
                self._fail("silence", f"no target came for {silent:.1f} s")

    def _compare(self, longest: float) -> Steps:
        """Read the joints; keep how far they are from their setpoint."""
        found = yield from self._query(self._where, longest)
        if found is not None:
            away = max(abs(a - b) for a, b in zip(found, self._setpoint))
            self._deviation = max(away, self._deviation or 0.0)

    def _check_stopped(self) -> None:
        if self._stopped_by:
            why = f"the arm was stopped meanwhile: {self._stopped_by}() was sent"
            self._fail("stopped", why)

    def _arrive(self, end: Point) -> Steps:
        """Wait until the joints are at the end of the path."""
        near = TOLERANCES["degree"]
        began, still, before = self._now, self._now, None
        while True:
            self._check_stopped()
            found = yield from self._query(self._where, max(self._timeout, READING_SECONDS))
            if found is not None:
                away = max(abs(a - b) for a, b in zip(found, end))
                if away <= near:
                    return
                if found != before:
                    still, before = self._now, found
                if self._now - still >= STILL_SECONDS:
                    self._fail("short", f"the arm stands still {away:.1f} degrees short of the end")
            if self._now - began >= self._timeout:
                self._fail("short", f"the arm is not at the end after {self._timeout:g} s")
            self._now, _ = yield Pause(self._now + READING_SECONDS)

    def _fail(self, ended: Ended, why: str) -> NoReturn:
        raise FollowFailed(why, self.report(ended))

    def _encoded(self, angles: Point, speed: int) -> EncodedRequest:
        return self._encode(targets_request(self._command, angles, speed))

    def _checked_path(self, path: Sequence[Any]) -> list[tuple[Point, float | None]]:
        """Return the waypoints of a path; every target is allowed."""
        found: list[tuple[Point, float | None]] = []
        before = -math.inf
        for number, each in enumerate(path):
            waypoint = each if isinstance(each, Waypoint) else Waypoint(each)
            name, time = f"path[{number}]", waypoint.time
            if time is not None:
                number_right = isinstance(time, int | float) and not isinstance(time, bool)
                if not number_right or not (before < time < math.inf and time >= 0):
                    allowed = "seconds, 0 or more, and later than the point before"
                    raise UsageError(f"{name}.time", time, allowed)
                before = float(time)
            if found and (time is None) != (found[-1][1] is None):
                message = "some points of the path have times, and others do not"
                raise UsageError("path", message=message)
            found.append(
                (self._checked(name, waypoint.target), None if time is None else float(time))
            )
        if not found:
            raise UsageError("path", path, "at least one target")
        return found

    def _checked(self, name: str, target: Target) -> Point:
        """Return a target as floats if it is allowed."""
        try:
            point: Point = tuple(map(float, target))
        except (TypeError, ValueError):
            raise UsageError(name, target, "a sequence of numbers") from None
        row = self._target.request[0].fields[row_index(self._target.request[0])].name
        arguments: tuple[str, ...] = self._target.request_type.__match_args__
        names = [each for each in arguments if each != row]
        # Some editions also need a mode. It is not sent, so any allowed one will do.
        fields = named_fields(self._target.request)
        others = [(*fields[each][0].choices, self._speed)[0] for each in names]
        try:
            self._encode(targets_request(self._target, point, *others))
        except UsageError as error:
            raise UsageError(name, message=f"{name}: {error}") from None
        return point


def _checked_rate(rate: float | None) -> float:
    if rate is None:
        return USUAL_RATE
    right = isinstance(rate, int | float) and not isinstance(rate, bool)
    if not right or not LEAST_RATE <= rate <= HIGHEST_RATE:
        raise UsageError("rate", rate, f"{LEAST_RATE:g} to {HIGHEST_RATE:g} targets a second")
    return float(rate)


def _on_lines(table: Table) -> OnLines:
    """Return the function that interpolates between coordinates on straight lines.

    Raises:
        UsageError: the geometry of the arm is not known.
    """
    geometry, variant = geometry_of(table), table.in_role("coordinate targets").request[0]
    indices = indices_of(variant.fields[row_index(variant)].cases[0].numbers)
    if geometry is None or indices is None:
        message = f"coords: {table.robot.why_no_geometry}; follow() needs it"
        raise UsageError("coords", message=message)
    return OnLines(geometry, indices, joint_limits(table))


def _bounds(limits: PathLimits, speed: float, acceleration: float, joints: int) -> Bounds:
    """Return the bounds of each joint: the user's, or else what the arm can do."""
    if not isinstance(limits, PathLimits):
        raise UsageError("limits", limits, "PathLimits")
    accelerations = _each("limits.acceleration", limits.acceleration, acceleration, joints)
    usual_jerk = tuple(each / JERK_SECONDS for each in accelerations)
    velocities = _each("limits.velocity", limits.velocity, speed, joints)
    for joint, velocity in enumerate(velocities):
        if velocity > speed:
            allowed = f"up to {speed:g} degrees a second, by the speed of the call and the edition"
            raise UsageError(f"limits.velocity[{joint}]", velocity, allowed)
    return Bounds(velocities, accelerations, _each("limits.jerk", limits.jerk, usual_jerk, joints))


def _each(
    name: str, chosen: float | Sequence[float] | None, usual: float | Point, joints: int
) -> Point:
    """Return a bound for each joint."""
    value = usual if chosen is None else chosen
    each: Point = ()
    with suppress(TypeError, ValueError):
        each = tuple(map(float, value)) if isinstance(value, Sequence) else (float(value),) * joints
    if len(each) != joints or not all(0 < one < math.inf for one in each):
        raise UsageError(name, chosen, f"a number above 0, or {joints} of them")
    return each
