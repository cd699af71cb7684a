"""Axes, their position, and their targets. Times are seconds of the owner's clock."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from copy import copy

from cobotwire.simulator.motion.hand import Hand, TimedPoint
from cobotwire.simulator.motion.legs import Leg, Plan, Point, Route, Turn


class Axes:
    """Axes that move together and stop together, with limited acceleration.

    Nothing runs in the background: the position is computed when it is needed, so that time may
    pass in steps of any size.
    """

    def __init__(self, position: Sequence[float], acceleration: float, lag: float = 0.0) -> None:
        """Rest; ``acceleration`` is the largest one, in units per second squared.

        With a ``lag``, in seconds, the axes reach each planned position that much later, as servos
        do.
        """
        self._lag = lag
        # Earlier plans of the axes, each with the time until which it applied.
        self._past: deque[tuple[float, Axes]] = deque()
        self._rest: Point = tuple(position)
        self._acceleration = acceleration
        self._leg: Leg | Hand | None = None
        self._since = 0.0
        self._waiting: deque[Plan] = deque()
        self._paused = False

    def position(self, now: float) -> Point:
        """Return where the axes are."""
        if self._lags:
            return self._before(now).position(now - self._lag)
        leg = self._at(now)
        return self._rest if leg is None else leg.position(now - self._since)

    def speed(self, now: float) -> Point:
        """Return how fast each axis is, in units per second."""
        if self._lags:
            return self._before(now).speed(now - self._lag)
        leg = self._at(now)
        return (0.0,) * len(self._rest) if leg is None else leg.speed(now - self._since)

    def target(self, now: float) -> Point:
        """Return where the axes will stop, after all waiting targets."""
        leg = self._at(now)
        if self._waiting:
            return self._waiting[-1].points[-1]
        return self._rest if leg is None else leg.end

    def points_ahead(self, now: float) -> list[Point]:
        """Return the points that the axes will pass, in this motion and the waiting ones."""
        leg = self._at(now)
        points = [point for plan in self._waiting for point in plan.points]
        if isinstance(leg, Route):
            points += leg.braked(now - self._since, self._acceleration).rest().points
        return points if leg is None else [leg.end, *points]

    def stop_at(self, now: float) -> Point:
        """Return where the axes would stop if they braked now."""
        leg = self._at(now)
        return self._rest if leg is None else self._braked(leg, now).end

    def moving(self, now: float) -> bool:
        """Return whether the axes move."""
        if self._lags and self._before(now).moving(now - self._lag):
            return True
        return self._at(now) is not None

    def go(self, target: Sequence[float], rate: float, now: float, *, queue: bool = False) -> None:
        """Move to ``target`` at ``rate`` units per second; ``queue``: after the present motion.

        Otherwise forget the present motion and all waiting targets: moving axes turn to the new
        target without stopping.
        """
        self._keep(now)
        plan = Plan((tuple(target),), rate)
        leg = self._at(now)
        if leg is None or queue or self._paused:
            self._add(plan, now, queue)
            return
        time = now - self._since
        self._waiting.clear()
        start, speed = leg.position(time), leg.speed(time)
        self._leg = Turn(start, speed, plan.points[0], rate, self._acceleration)
        self._since = now

    def follow(
        self, points: Sequence[Point], rate: float, now: float, *, queue: bool = False
    ) -> None:
        """Move along points that are close to each other; the first follows the present position.

        Without ``queue``, moving axes stop first, since their present motion is another route.
        """
        self._keep(now)
        if not queue and not self._paused:
            self.brake(now)
        self._add(Plan(tuple(points), rate), now, queue)

    def _add(self, plan: Plan, now: float, queue: bool) -> None:
        if not queue:
            self._waiting.clear()
        self._waiting.append(plan)
        if self._at(now) is None:
            self._since = now
            self._start()

    def brake(self, now: float) -> None:
        """Brake, and forget every target."""
        self._keep(now)
        leg = self._at(now)
        self._waiting.clear()
        if leg is not None:
            self._leg, self._since = self._braked(leg, now), now

    def halt(self, now: float) -> None:
        """Stop at once, like axes that nothing drives, and forget every target."""
        self._rest = self.position(now)
        self._leg = None
        self._waiting.clear()
        self._past.clear()

    def lead(self, points: Sequence[TimedPoint], now: float) -> None:
        """Let a hand lead the axes from where they are; forget every target."""
        self.halt(now)
        if points:
            start = [] if points[0][0] == 0 else [(0.0, self._rest)]
            if len(start) + len(points) == 1:
                self._rest = points[0][1]
                return
            self._leg, self._since = Hand([*start, *points]), now

    def forget(self, now: float) -> None:
        """Forget the waiting targets; the present motion continues."""
        self._keep(now)
        self._at(now)
        self._waiting.clear()

    def place(self, position: Sequence[float], now: float) -> None:
        """Assign other numbers to the present position, as a calibration does."""
        self.halt(now)
        self._rest = tuple(position)

    def pause(self, now: float) -> None:
        """Brake, and keep the targets."""
        self._keep(now)
        leg = self._at(now)
        if self._paused:
            return
        self._paused = True
        if leg is not None and not isinstance(leg, Hand):
            self._leg = braked = leg.braked(now - self._since, self._acceleration)
            self._since = now
            self._waiting.appendleft(braked.rest())

    def resume(self, now: float) -> None:
        """Continue towards the targets, from standstill."""
        self._keep(now)
        if self._at(now) is None and self._paused:
            self._since = now
        self._paused = False
        if self._leg is None:
            self._start()

    @property
    def _lags(self) -> bool:
        return self._lag > 0 and not isinstance(self._leg, Hand)

    def _keep(self, now: float) -> None:
        """Keep the present plan, which applies until ``now``, for axes that lag."""
        if self._lag:
            self._past.append((now, self._without_lag()))

    def _without_lag(self) -> Axes:
        """Return the same axes without a lag."""
        found = copy(self)
        found._lag, found._waiting = 0.0, self._waiting.copy()
        return found

    def _before(self, now: float) -> Axes:
        """Return the axes with the plan that applied one lag ago."""
        while self._past and self._past[0][0] <= now - self._lag:
            self._past.popleft()
        return self._past[0][1] if self._past else self._without_lag()

    def _braked(self, leg: Leg | Hand, now: float) -> Leg | Hand:
        return leg.braked(now - self._since, self._acceleration)

    def _at(self, now: float) -> Leg | Hand | None:
        """Return the present leg; end those that are over by now."""
        if self._leg is not None and now >= self._since + self._leg.duration:
            self._keep(now)
        while self._leg is not None and now >= self._since + self._leg.duration:
            self._since += self._leg.duration
            self._rest = self._leg.end
            self._leg = None
            self._start()
        return self._leg

    def _start(self) -> None:
        """Begin the next waiting motion; skip targets at which the axes already are."""
        while self._leg is None and self._waiting and not self._paused:
            plan = self._waiting.popleft()
            points = [self._rest, *(point for point in plan.points if point != self._rest)]
            if len(points) > 1:
                self._leg = Route(points, plan.rate, self._acceleration)
