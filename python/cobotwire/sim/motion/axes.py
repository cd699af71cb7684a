"""Some axes, where they stand, and where they are going. Times are the owner's seconds."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

from cobotwire.sim.motion.legs import Leg, Order, Point, Route, Turn


class Axes:
    """Axes that move together and end together, at most at ``acceleration`` units a square second.

    Nothing runs here: where the axes are is worked out when it is asked, so that time may go by in
    steps of any size.
    """

    def __init__(self, position: Sequence[float], acceleration: float) -> None:
        self._rest: Point = tuple(position)
        self._acceleration = acceleration
        self._leg: Leg | None = None
        self._since = 0.0
        self._waiting: deque[Order] = deque()
        self._paused = False

    def position(self, now: float) -> Point:
        """Where the axes are."""
        leg = self._at(now)
        return self._rest if leg is None else leg.position(now - self._since)

    def speed(self, now: float) -> Point:
        """How fast each axis is, in units a second."""
        leg = self._at(now)
        return (0.0,) * len(self._rest) if leg is None else leg.speed(now - self._since)

    def target(self, now: float) -> Point:
        """Where the axes will stand at the end, if what waits is done too."""
        leg = self._at(now)
        if self._waiting:
            return self._waiting[-1].points[-1]
        return self._rest if leg is None else leg.end

    def stop_at(self, now: float) -> Point:
        """Where the axes would stand if they braked now."""
        leg = self._at(now)
        if leg is None:
            return self._rest
        return leg.braked(now - self._since, self._acceleration).end

    def moving(self, now: float) -> bool:
        """Whether any axis is in motion."""
        return self._at(now) is not None

    def go(self, target: Sequence[float], rate: float, now: float, *, queue: bool = False) -> None:
        """Move to ``target`` at ``rate`` units a second; behind what is under way if ``queue``.

        Otherwise all that is under way or waits is forgotten, and moving axes turn to the new
        target without standing in between.
        """
        order = Order((tuple(target),), rate)
        leg = self._at(now)
        if leg is None or queue or self._paused:
            self._add(order, now, queue)
            return
        time = now - self._since
        self._waiting.clear()
        start, speed = leg.position(time), leg.speed(time)
        self._leg = Turn(start, speed, order.points[0], rate, self._acceleration)
        self._since = now

    def follow(
        self, points: Sequence[Point], rate: float, now: float, *, queue: bool = False
    ) -> None:
        """Move along points that follow each other closely; the first is behind where they stand.

        Moving axes stand first, for what is under way is another route.
        """
        if not queue and not self._paused:
            self.brake(now)
        self._add(Order(tuple(points), rate), now, queue)

    def _add(self, order: Order, now: float, queue: bool) -> None:
        if not queue:
            self._waiting.clear()
        self._waiting.append(order)
        if self._at(now) is None:
            self._since = now
            self._start()

    def brake(self, now: float) -> None:
        """Stand as soon as the axes can, and forget every target."""
        leg = self._at(now)
        self._waiting.clear()
        if leg is not None:
            self._leg = leg.braked(now - self._since, self._acceleration)
            self._since = now

    def halt(self, now: float) -> None:
        """Stand at once, as axes that nothing drives any more; every target is forgotten."""
        self._rest = self.position(now)
        self._leg = None
        self._waiting.clear()

    def forget(self, now: float) -> None:
        """Forget what waits; what is under way goes on."""
        self._at(now)
        self._waiting.clear()

    def place(self, position: Sequence[float], now: float) -> None:
        """Call the present position by other numbers, as a calibration does."""
        self.halt(now)
        self._rest = tuple(position)

    def pause(self, now: float) -> None:
        """Stand as soon as the axes can, and keep the way."""
        leg = self._at(now)
        if self._paused:
            return
        self._paused = True
        if leg is not None:
            self._leg = leg.braked(now - self._since, self._acceleration)
            self._since = now
            self._waiting.appendleft(self._leg.rest(self._leg.end))

    def resume(self, now: float) -> None:
        """Go on with the way, from a standstill."""
        if self._at(now) is None and self._paused:
            self._since = now
        self._paused = False
        if self._leg is None:
            self._start()

    def _at(self, now: float) -> Leg | None:
        """The leg of the moment, after those that are over by now."""
        while self._leg is not None and now >= self._since + self._leg.duration:
            self._since += self._leg.duration
            self._rest = self._leg.end
            self._leg = None
            self._start()
        return self._leg

    def _start(self) -> None:
        """Set out for what waits; where the axes stand already, nothing has to be done."""
        while self._leg is None and self._waiting and not self._paused:
            order = self._waiting.popleft()
            points = [self._rest, *(point for point in order.points if point != self._rest)]
            if len(points) > 1:
                self._leg = Route(points, order.rate, self._acceleration)
