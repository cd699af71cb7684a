"""Following paths and live targets without stops."""

from __future__ import annotations

from collections.abc import AsyncIterable  # unasync: off
from contextlib import suppress
from math import inf
from typing import TYPE_CHECKING

from cobotwire.client.aio import AsyncClient
from cobotwire.client.aio_target_sources import AsyncTargets, TaskMailbox  # unasync: off
from cobotwire.client.opening import check_seconds
from cobotwire.client.target_sources import Targets, is_path, source_of
from cobotwire.protocol.errors import CobotwireError, ProtocolError, ReplyTimeout
from cobotwire.protocol.lazy import import_aside
from cobotwire.session.motion import Outcome, Query
from cobotwire.session.paths import FollowReport, PathLimits, Pause, Send, Source

if TYPE_CHECKING:
    from cobotwire.session.following import Follow

# Percent of the fastest, unless the caller says otherwise.
USUAL_SPEED = 50
# How long a live source may be silent, and how long the arm may take to the end of a path after its
# last setpoint.
SILENCE_SECONDS, ARRIVAL_SECONDS = 0.5, 10.0


class AsyncFollowingClient(AsyncClient):
    """Follows paths, by commands to which the edition gives a role or an effect."""

    async def follow(
        self,
        path: Targets | AsyncTargets,
        *,
        speed: int = USUAL_SPEED,
        rate: float | None = None,
        coords: bool = False,
        limits: PathLimits | None = None,
        silence: float | None = SILENCE_SECONDS,
        timeout: float = ARRIVAL_SECONDS,
    ) -> FollowReport:
        """Move along a path without stopping at its points, and wait until the arm is at its end.

        Setpoints are sent at a fixed rate while a new target replaces the old one (*fresh mode*,
        restored afterwards). Their speed, acceleration and jerk are limited (extra ``motion``).

        Args:
            path: a sequence of targets or of :class:`Waypoint`, which are passed on a smooth curve;
                or a live source: an iterator at any rate, of which the newest target counts, or a
                function that returns the newest target, or None, until it raises StopIteration.
            speed: percent of the fastest, which no joint exceeds.
            rate: setpoints a second; default: 50. No more are sent than the line and the arm take,
                as measured by the reply times of three queries.
            coords: whether targets are coordinates of the flange in the frame of the base: it moves
                on straight lines, with rounded corners.
            limits: how fast joints may move and speed up; default: what the edition states.
            silence: a live source that brings no target for that many seconds ends the motion with
                an error; None: it may be silent.
            timeout: seconds to wait at most for the arm after the last setpoint.

        Returns:
            How it went.

        Raises:
            UsageError: an argument is not allowed, or the edition cannot follow; a path is checked
                as a whole before the arm moves. A target of a live source stops the arm.
            LinkError: the transport is gone.
            ReplyTimeout: the arm does not report where it is.
            FollowFailed: the source was silent, the program stalled, or the arm stopped short.
        """
        # Few programs follow paths, and kinematics take long to import.
        import_aside("cobotwire.session.following")
        from cobotwire.session.following import Follow

        check_seconds("silence", silence)
        check_seconds("timeout", timeout)
        given = path if is_path(path) else self._source(path)
        job = None
        try:
            job = Follow(
                self._settings.codec.table,
                self._encoder.encode_request,
                self._baudrate,
                given,
                speed=speed,
                rate=rate,
                coords=coords,
                limits=limits,
                silence=silence,
                timeout=timeout,
            )
            await self._run_follow(job)
        except BaseException as error:
            if job is not None and job.moving:
                await self._stop_for(error)
            raise
        finally:
            if isinstance(given, Source):
                given.close()
            if job is not None and job.restore is not None:
                with suppress(CobotwireError):
                    await self._connection.send(job.restore, None)
        return job.report()

    def _source(self, path: Targets | AsyncTargets) -> Source:
        # unasync: off
        if isinstance(path, AsyncIterable):
            return TaskMailbox(path)
        # unasync: on
        return source_of(path)

    async def _run_follow(self, job: Follow) -> None:
        steps = job.steps(self._connection.now())
        step = next(steps, None)
        while step is not None:
            outcome = await self._take_step(step)
            try:
                step = steps.send(outcome)
            except StopIteration:
                return

    async def _take_step(self, step: Pause | Query | Send) -> Outcome:
        now, result = self._connection.now, None
        if isinstance(step, Pause):
            await self._connection.sleep(max(0.0, step.until - now()))
        elif isinstance(step, Send):
            await self._connection.send(step.request, None)
        elif step.longest == inf:
            result = await self._call(step.request)
        else:
            with suppress(ReplyTimeout, ProtocolError):
                result = await self._call(step.request, step.longest, step.longest)
        return Outcome(now(), result)
