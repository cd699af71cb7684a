"""What a server shows, a live session or a recording, and what its pages request."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

from cobotwire import codec as codecs
from cobotwire.editions import Edition
from cobotwire.inspect.following import FollowedRecording
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.json_values import as_json_value
from cobotwire.protocol.limits import Limits, limited
from cobotwire.protocol.refusals import refusals
from cobotwire.protocol.table import Table
from cobotwire.studio.arm_line import ArmLine
from cobotwire.studio.controls import controls
from cobotwire.studio.describing import Describer
from cobotwire.studio.explained import Explainer
from cobotwire.studio.live import LiveSession
from cobotwire.studio.recorded import RecordedSession
from cobotwire.studio.robot_facts import robot_facts
from cobotwire.studio.sending import Control, NotPermitted, Preparer
from cobotwire.studio.simulated_line import SimulatedLine, scenarios
from cobotwire.studio.viewers import Viewer

# A page must report at least this often that it still holds a button; it does so every 0.1 s.
LONGEST_SILENCE_SECONDS = 0.5
# How many requests of pages may wait for replies at a time.
SENDERS = 4


class Stage:
    """One session, its control, and the pages that watch."""

    def __init__(
        self,
        edition: Edition,
        session: LiveSession | RecordedSession,
        control: Control,
        simulated: SimulatedLine | None = None,
        address: int | str | None = None,
        limits: Limits | None = None,
        silence: float = LONGEST_SILENCE_SECONDS,
        drawn: Table | None = None,
    ) -> None:
        """Show a session.

        ``limits`` are those of the client; ``silence`` is the time after which a held motion ends,
        in seconds. The page draws the arm of the table ``drawn``, which may have a user's
        geometry; no check uses it.
        """
        self._drawn = drawn or edition.TABLE
        self.table, self.session, self.control = edition.TABLE, session, control
        self.explainer = Explainer(edition, codecs.load(self.table))
        self.preparer = Preparer(self.table, address, limits)
        self._limits, self.silence = Limits() if limits is None else limits, silence
        # Only what pages send is limited: the frames of other programs need the edition's table.
        self.offered = limited(self.table, self._limits)
        self.simulated = simulated
        self._scenarios = scenarios(self.table) if simulated is not None else []
        self._senders = ThreadPoolExecutor(SENDERS, "cobotwire-send")
        # Stop has its own thread, so that it does not wait for other requests.
        self._stopper = ThreadPoolExecutor(1, "cobotwire-stop")
        self.viewers: dict[str, Viewer] = {}
        # What ends the motion that a page holds, by page.
        self.held: dict[str, Callable[[], object]] = {}
        if isinstance(session, LiveSession) and isinstance(session.line, ArmLine):
            session.line.is_held = lambda: bool(self.held)

    def close(self) -> None:
        """Forget requests that were not sent yet."""
        self._senders.shutdown(wait=False, cancel_futures=True)
        self._stopper.shutdown(wait=True)

    def describer(self) -> Describer:
        """Return a new describer of the session's entries."""
        return Describer(codecs.load(self.table))

    def hello(self, viewer: Viewer) -> dict[str, Any]:
        """Return what a page needs first."""
        session, live = self.session, isinstance(self.session, LiveSession)
        hello = {
            "page": viewer.page,
            "robot": robot_facts(self._drawn),
            "controls": controls(self.offered, refusals(self.table, self._limits)),
            "mode": "live" if live else "recording",
            "simulated": self.simulated is not None,
            "motionPermitted": self.control.motion_permitted,
            "scenarios": [choice._asdict() for choice in self._scenarios],
            "startNs": str(session.start_ns),
            "url": session.interface.url,
        }
        if isinstance(session, RecordedSession):
            recording = {"name": session.name, "seconds": session.seconds}
            hello["recording"] = recording | {"remarks": session.remarks}
        return hello

    def open(self, viewer: Viewer) -> None:
        """Add a page."""
        self.viewers[viewer.page] = viewer
        viewer.show(hello=self.hello(viewer), **self.state(viewer.page))
        if isinstance(self.session, LiveSession):
            self.session.open(viewer)

    def leave(self, viewer: Viewer) -> None:
        """Remove a page; if it could send, others can now."""
        self.viewers.pop(viewer.page, None)
        if isinstance(self.session, LiveSession):
            self.session.close(viewer)
        self.control.release(viewer.page)
        self._show()

    def state(self, page: str) -> dict[str, Any]:
        """Return for a page who may send, the scenario, and how often the arm was stopped.

        A page proves by its id that it may send, so no page gets the id of another one.
        """
        mine, taken = page == self.control.page, self.control.page not in ("", page)
        control = {"mine": mine, "taken": taken, "motion": mine and self.control.motion}
        scenario = self.simulated.scenario if self.simulated is not None else ""
        states = {"control": control, "watching": len(self.viewers), "scenario": scenario}
        if isinstance(self.session, LiveSession) and isinstance(self.session.line, ArmLine):
            states["stops"] = self.session.line.stops
        return states

    def set_control(self, page: str, take: bool) -> None:
        """Let a page send, or let it send no longer; then the motion that it holds is stopped.

        Raises:
            NotPermitted: another page may send, or there is no such page.
        """
        if page not in self.viewers:
            raise NotPermitted("this page is not connected")
        if take:
            self._line()
            self.control.take(page)
        else:
            self.control.release(page)
            self._end_held(page)
        self._show()

    def set_motion(self, page: str, on: bool) -> None:
        """Turn the motion switch of a page; off stops the motion that the page holds.

        Raises:
            NotPermitted: it may not.
        """
        self.control.switch_motion(page, on)
        if not on:
            self._end_held(page)
        self._show()

    def _end_held(self, page: str) -> None:
        if page in self.held:
            self.held[page]()

    def choose_scenario(self, page: str, name: object) -> None:
        """Begin a fault scenario, or end it.

        Raises:
            NotPermitted: the page may not, or the arm is not simulated.
            UsageError: there is no such scenario.
        """
        self.control.check_page(page)
        if self.simulated is None:
            raise NotPermitted("faults are injected only into a simulated arm")
        if not isinstance(name, str):
            raise UsageError("scenario", name, "the name of a scenario, or an empty text")
        self.simulated.choose(name)
        self._show()

    async def send(
        self, page: str, name: object, texts: object, stops: object, *, force: bool
    ) -> Any:
        """Send a command for a page; return its result as JSON values.

        ``stops`` is the number of stops that the page knew when the user requested the command.
        Unless it is a query, the command is refused if the number has changed: a stop can overtake
        a request that waits in the browser or on the network.

        Raises:
            NotPermitted: the page may not send it.
            CobotwireError: an argument is wrong, or the arm does not obey or reply.
        """
        line = self._line()
        command = self.preparer.command(name)
        self.control.check(page, command)
        arguments = self.preparer.arguments(command, texts)
        # A wrong value is reported before the check that the arm obeys.
        self.preparer.encoded(command, arguments)
        if type(stops) is not int:
            if command.safety != "query":
                raise NotPermitted(
                    f"{command.name} was not sent: the request does not say how many stops the "
                    "page knows; reload the page"
                )
            stops = line.stops
        permit = partial(self.control.check, page, command)
        result = await asyncio.get_running_loop().run_in_executor(
            self._senders, line.call, command, arguments, force, permit, stops
        )
        return as_json_value(result)

    async def stop(self) -> None:
        """Stop the arm: any page may, at any time, and nothing that waits delays it.

        Raises:
            UsageError: the edition has no stop.
            LinkError: the port is gone.
        """
        line = self._line()
        self.count_stop()
        await asyncio.get_running_loop().run_in_executor(self._stopper, line.send_stop)

    def count_stop(self) -> None:
        """Refuse every motion that was requested before now, without sending stop.

        Raises:
            NotPermitted: nothing can be sent to a recording.
        """
        self._line().stops += 1
        self._show()

    def _line(self) -> ArmLine:
        if not isinstance(self.session, LiveSession):
            raise NotPermitted("nothing can be sent to a recording")
        if isinstance(self.session.line, FollowedRecording):
            raise NotPermitted(
                "this page only shows a recording: stop the program that moves the arm, "
                "or use the arm's switch"
            )
        return self.session.line

    def _show(self) -> None:
        for viewer in self.viewers.values():
            viewer.show(**self.state(viewer.page))
