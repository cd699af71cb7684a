"""Follow paths and live targets without stops."""

from __future__ import annotations

from collections.abc import AsyncIterable  # unasync: off
from contextlib import suppress
from math import inf
from typing import TYPE_CHECKING, Any

from cobotwire.client.aio import AsyncClient
from cobotwire.client.aio_target_sources import AsyncTargets, TaskMailbox  # unasync: off
from cobotwire.client.opening import check_seconds
from cobotwire.client.target_sources import Targets, is_path, source_of
from cobotwire.protocol.errors import CobotwireError, ProtocolError, ReplyTimeout, UsageError
from cobotwire.protocol.lazy import import_aside
from cobotwire.session import Traffic
from cobotwire.session.events import sent_command
from cobotwire.session.motion import Outcome, Query
from cobotwire.session.paths import FollowReport, PathLimits, Pause, Send, Source

if TYPE_CHECKING:
    from cobotwire.session.following import Follow

# The default speed, in percent of the highest.
USUAL_SPEED = 50
# How long a live source may be silent, and how long the arm may take to arrive after the last
# setpoint.
SILENCE_SECONDS, ARRIVAL_SECONDS = 0.5, 10.0


class AsyncFollowingClient(AsyncClient):
    """Follows paths, with the commands that have the needed roles or effects in the edition."""

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

        Setpoints are sent at a fixed rate in *fresh mode*, in which a new target replaces the old
        one; afterwards the mode is restored. Their speed, acceleration and jerk are limited (extra
        ``motion``).

        Args:
            path: a sequence of targets or of :class:`Waypoint`, or a live source. The arm passes
                the points of a sequence on a smooth curve. A live source is an iterator (only its
                newest target counts), or a function that returns the newest target or None, and
                raises StopIteration at the end.
            speed: percent of the highest speed of the joints; no joint exceeds it.
            rate: setpoints a second; default: 50. It is lowered if the line or the arm is too slow
                for it; three queries before the motion measure that.
            coords: whether targets are coordinates of the flange in the frame of the base: it moves
                on straight lines, with rounded corners.
            limits: how fast joints may move and speed up; default: what the edition states.
            silence: if a live source yields no target for that many seconds, the motion ends with
                an error; None: never.
            timeout: seconds to wait at most for the arm after the last setpoint.

        Returns:
            The report on the motion.

        Raises:
            UsageError: an argument is not allowed, another ``follow`` is under way, or the edition
                cannot follow; a path is checked as a whole before the arm moves. A bad target of a
                live source stops the arm.
            LinkError: the transport is gone.
            ReplyTimeout: the arm does not report where it is.
            FollowFailed: the source was silent, the program stalled, the arm was stopped by
                another part of the program, or stopped short of the target.
        """
        # Few programs follow paths, and kinematics take long to import.
        import_aside("cobotwire.session.following")
        from cobotwire.session.following import Follow

        check_seconds("silence", silence)
        check_seconds("timeout", timeout)
        if not self._connection.follows.acquire(blocking=False):
            message = "another follow() moves an arm of this connection; it has to end first"
            raise UsageError("path", message=message)
        source: Any = None
        job = None
        try:
            source = path if is_path(path) else self._source(path)
            job = Follow(
                self._settings.codec.table,
                self._encoder.encode_request,
                self._baudrate,
                source,
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
            self._connection.follows.release()
            if isinstance(source, Source):
                source.close()
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
        def watch(traffic: Traffic) -> None:
            # A dead man's switch, or another part of the program, may have stopped the arm.
            command = sent_command(traffic, self._settings.codec)
            if command is not None:
                job.note_sent(command)

        remove = self._connection.listeners.add(watch)
        steps = job.steps(self._connection.now())
        step = next(steps, None)
        try:
            while step is not None:
                outcome = await self._take_step(step)
                step = steps.send(outcome)
        except StopIteration:
            return
        finally:
            remove()

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
