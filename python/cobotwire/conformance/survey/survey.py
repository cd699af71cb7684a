"""The course of a survey: which test cases run, in which order, and what is read in between."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from typing import Any

from cobotwire import editions
from cobotwire.client import Client
from cobotwire.conformance.device import DeviceConnection, Permissions, Step, Tester
from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups import (
    agreement,
    at_rest,
    motion,
    on_the_way,
    queries,
    references,
    settings,
)
from cobotwire.conformance.device.mover import POLL, Mover
from cobotwire.conformance.device.probe import Body, Probe
from cobotwire.conformance.device.requests import as_row, request_of
from cobotwire.conformance.report import Cause, Result
from cobotwire.conformance.suite import Group
from cobotwire.conformance.survey.facts import Facts, Frames
from cobotwire.conformance.survey.interpreting import Interpreter
from cobotwire.inspect.cross_checks import CrossChecks, Mistake
from cobotwire.inspect.identification import other_edition
from cobotwire.inspect.readings import Key, Row, Source, sources, target_of
from cobotwire.protocol.effects import Reports, effect_of
from cobotwire.protocol.limits import joint_limits
from cobotwire.protocol.table import Command, Table
from cobotwire.transport.tapped import borrowed

QUERIES = (queries.QUERIES, at_rest.REACHED_AT_REST, agreement.CALCULATION)
SETTINGS = (settings.SETTINGS, settings.SHOWN_AMONG, references.REFERENCES)
MOTIONS = (motion.POSES, motion.JOINTS, on_the_way.STOPPING)
# The time that an arm has for a query by which its edition is recognised, in seconds.
EDITION_SECONDS = 0.5
# In degrees: how far the motions leave the present pose, how far the first step turns a joint, and
# at which distance the first step is stopped. The speed is in percent.
AROUND, FIRST, TOO_FAR = 5.0, 1.0, 3.0
SPEED = 10
# How long a survey lasts at most, in seconds.
LONGEST = 600.0
# Private readings, such as passwords: they are not requested.
PRIVATE = frozenset({"ssid", "password"})
# Readings that identify a single device: their bytes are replaced by a hash.
SERIAL = frozenset({"serial", "serial_number", "mac", "uid", "uuid"})

Progress = Callable[[str, int, int], None]


class Survey:
    """Surveys the arm at the other end of a connection; ``facts`` holds what is found so far."""

    def __init__(
        self,
        connection: DeviceConnection,
        table: Table,
        *,
        package: str = "",
        settings: bool = False,
        motion: bool = False,
        earlier: Mapping[str, Any] | None = None,
        sources: Mapping[str, str] | None = None,
        on_private: Callable[[bool], object] = bool,
        address: int | str | None = None,
    ) -> None:
        """Prepare a survey; nothing is sent.

        Args:
            connection: the connection to the arm.
            table: the edition that the arm speaks.
            package: the name by which ``editions.load`` finds the edition.
            settings: whether settings are stored and restored.
            motion: whether the arm makes a few small motions.
            earlier: the content of the file of an interrupted survey; facts that it decided are not
                tested again.
            sources: where the spec defines each command, by name.
            on_private: called with True before a query for a device's identity is sent, and
                with False after its replies.
            address: the device's address, by number or name; left out: the edition's first one.
        """
        self.table, self.facts = table, Facts(table)
        self.hashed: list[str] = []
        self.firmware: dict[str, str] = {}
        self.finished = False
        # What has run: 1 queries, 2 also settings, 3 also motion.
        self.level = 1
        # The options of this survey, or the earlier one, whose test cases have not all run.
        before = (earlier or {}).get("left_out", ())
        options = {"--settings": settings, "--allow-motion": motion}
        self.left_out = [name for name, chosen in options.items() if chosen or name in before]
        # Why the arm was not surveyed, or not moved although it should be; else empty.
        self.obstacle = ""
        # Whether the arm speaks another edition.
        self.other = False
        self.mistakes: list[Mistake] = []
        self._package, self._motion = package or table.edition, motion
        facts = earlier["facts"] if earlier else ()
        self._done = {f["fact"] for f in facts if f["verdict"] != "not seen"}
        self._settings, self._on_private = settings, on_private
        allowed = Permissions(frozenset({"setting"} if settings else ()))
        self.address = address
        self._tester = Tester(
            connection, table, permissions=allowed, sources=sources, address=address
        )
        self._interpreter = Interpreter(table, self._tester.device, self.facts)
        self._snapshots: list[dict[Key, Row]] = []
        self._evidence: dict[Key, list[Frames]] = {}
        self._results: list[Result] = []
        # Why the survey ended early: the arm stopped replying, or it took too long.
        self._ended = ""

    @cached_property
    def _checks(self) -> CrossChecks:
        return CrossChecks(self.table)

    @cached_property
    def _every_step(self) -> list[Step]:
        return list(self._tester.steps())

    @property
    def contradicted(self) -> list[str]:
        """The contradicted facts: each reason once, after the names of its facts."""
        names: dict[str, list[str]] = {}
        for fact in self.facts.with_verdict("contradicted"):
            names.setdefault(fact.why, []).append(fact.fact.partition("/")[2])
        return [f"{', '.join(facts)}: {why}" for why, facts in names.items()]

    @property
    def questions(self) -> list[str]:
        """Observations that decide no fact, but that the owner may be able to explain."""
        return self._interpreter.questions

    def run(self, progress: Progress = lambda name, done, count: None) -> None:
        """Run the whole survey; what was changed is restored, however it ends.

        Raises:
            LinkError: the connection is lost; the facts hold what was found until then.
            KeyboardInterrupt: the run was interrupted, and the arm was stopped; the facts hold what
                was found until then.
        """
        progress("which edition the arm speaks", 0, 1)
        self.other = self._is_other_edition()
        if self.other:
            return
        try:
            queries, setting = self._steps(QUERIES), self._steps(SETTINGS)
            self._run_steps(queries, progress)
            self.level = 2 if self._settings and not self._ended else 1
            self._run_steps(setting, progress)
            self._note_end("--settings", self._settings)
            self._read_now(progress)
            if self._motion:
                self._move(progress)
            self._note_end("--allow-motion", self._motion)
            self.finished = not self._ended and not self.left_out
        finally:
            try:
                self._tester.end()
            finally:
                self._conclude()

    def _note_end(self, option: str, chosen: bool) -> None:
        if chosen and not self._ended:
            self.left_out.remove(option)

    def _is_other_edition(self) -> bool:
        """Return whether the arm speaks another edition of this package.

        Then a survey would show nothing about the facts of this edition.
        """
        if self.table.edition not in editions.names():
            return False
        client_type: type[Client] = editions.load(self._package).CLIENT
        transport = self._tester.connection.transport
        options: dict[str, Any] = {"timeout": EDITION_SECONDS, "address": self.address}
        other = None
        with (
            suppress(NotSupported),
            client_type(borrowed(transport), **options) as client,
        ):
            own, other = other_edition(client, self.table, transport, timeout=EDITION_SECONDS)
        if other is None:
            return False
        self.obstacle = (
            f"the arm speaks edition {other.edition}, not {self.table.edition}: it replies to "
            f"{other.query}{own.query and f', but not to {own.query}'}"
        )
        return True

    def _steps(self, groups: tuple[Group[Body], ...]) -> list[Step]:
        """Return the steps of the groups; first those of the commands that have a role."""
        order = [group.name for group in groups]
        found = [
            step
            for step in self._every_step
            if step.group.name in order
            and not self._tester.missing(step)
            and step.command is not None
            and not PRIVATE & {*states(step.command)}
            and self.facts.name(step.command.name, "command", _decides(step)) not in self._done
        ]
        return sorted(found, key=lambda s: (order.index(s.group.name), not s.command.role))  # type: ignore[union-attr]

    def _run_steps(self, steps: list[Step], progress: Progress) -> None:
        for at, step in enumerate(steps):
            if self._tester.connection.now > LONGEST:
                self._ended = f"it has taken {LONGEST:g} s"
            if self._ended:
                self.obstacle = f"the survey ended early: {self._ended}; --continue goes on"
                return
            progress(step.name, at, len(steps))
            private = step.command is not None and bool(SERIAL & {*states(step.command)})
            if private and step.command is not None:
                self.hashed.append(step.command.name)
                self._on_private(True)
            try:
                found = self._tester.results(step)
            finally:
                self._on_private(False)
            silent = (result.reason for result in found if result.cause is Cause.RUN_ENDED)
            self._ended = next(silent, "").rstrip(".")
            # Bytes that identify a device are not published as evidence.
            self._results += [replace(r, evidence=()) if private else r for r in found]

    def _read_now(self, progress: Progress) -> None:
        self._run_steps([Step(Group("readings", (), self._read), None)], progress)
        self.mistakes = self._checks.mistakes(self._snapshots)

    def _read(self, probe: Probe, sent: Row = ()) -> None:
        """Read each state that can be compared, by the queries that have had a reply."""
        replied, row = probe.device.noticed.reply_seconds, dict[Key, Row]()
        for source in sources(self.table):
            present = self.facts.name(source.query.name, "command", "present") in self._done
            compared = source.key in self._checks.keys or _is_version(source)
            if not compared or not (present or replied.get(source.query.name)):
                continue
            joints = range(1, self.table.joints + 1)
            arguments = [(joint,) for joint in joints] if source.of_joint else [()]
            requests = [request_of(source.query, *given) for given in arguments]
            values: list[float] = []
            for request in requests:
                try:
                    response = probe.device.request(request)
                except NotSupported:
                    break
                if response.valid is not None and response.valid.decoded is not None:
                    values += as_row(response.valid.decoded.fields[source.field.name])
                    frames = Frames(response.request.frame, response.valid.data)
                    self._evidence.setdefault(source.key, []).append(frames)
            if len(values) == len(source.numbers):
                row[source.key] = tuple(values)
        if sent and (target := target_of(self.table)):
            row[target[0]] = sent
        self._snapshots.append(row)

    def _move(self, progress: Progress) -> None:
        """Make a few small slow motions around the present pose; first a single small step."""
        if self._ended:
            return
        if self.mistakes:
            self.obstacle = "no motion: the readings already contradict the edition"
            return
        around = self._around()
        if not around:
            self.obstacle = "no motion: the edition or the arm does not report the joints' angles"
            return
        self.level, device = 3, self._tester.device
        classes = device.permissions.classes | {"motion", "power"}
        device.permissions = Permissions(classes, SPEED, around)
        for body in (self._first_step, self._poses):
            self._run_steps([Step(Group("first motions", (), body), None)], progress)
            self.mistakes = self._checks.mistakes(self._snapshots)
            if self.mistakes or self.obstacle:
                self.obstacle = self.obstacle or "no further motion: the first ones show a mistake"
                return
        self._run_steps(self._steps(MOTIONS), progress)

    def _around(self) -> tuple[tuple[float, float], ...]:
        """Return the range of each joint around the present pose; empty if it is not known."""
        query, found = self.table.find_role("joints"), list[tuple[float, float]]()
        key = query and (query.name, f"reply.{query.reply[0].fields[0].name}")
        stated = joint_limits(self.table) or ((-180.0, 180.0),) * self.table.joints
        for angle, (low, high) in zip(self._snapshots[-1].get(key, ()) if key else (), stated):
            middle = min(max(angle, low + AROUND), high - AROUND)
            found.append((middle - AROUND, middle + AROUND))
        return tuple(found)

    def _first_step(self, probe: Probe) -> None:
        """Move the joint nearest to zero by a degree; stop the arm if a joint goes too far."""
        mover, device = Mover(probe.device), probe.device
        start = mover.angles()
        at = min(range(len(start)), key=lambda joint: abs(start[joint]))
        high = device.permissions.workspace[at][1]
        by = FIRST if start[at] + FIRST <= high else -FIRST
        target = (*start[:at], round(start[at] + by, 2), *start[at + 1 :])
        device.request(mover.to(target))
        until, rest = device.connection.now + 20 * POLL, False
        while not rest or device.connection.now < until:
            here = mover.angles()
            if any(abs(now - then) > TOO_FAR for now, then in zip(here, start)):
                stop = device.command("stop")
                if stop is not None:
                    device.request(stop.request_type())
                self.obstacle = "no further motion: the arm went much further than the requested "
                self.obstacle += f"{by:g} degree of joint {at + 1}"
                why = f"Sent from {start} to {target}, the arm was at {here}, and was stopped."
                key = mover.targets.name, "command", "effect"
                self.facts.note(key, "contradicted", why)
                return
            moving = device.command("moving")
            rest = moving is None or device.is_set(moving.request_type()) is not True
            mover.rest(POLL)
        self._read(probe, target)

    def _poses(self, probe: Probe) -> None:
        """Go to poses in which no two joints are alike, and read what the arm reports there."""
        mover = Mover(probe.device)
        for which in (0, 1):
            mover.go(mover.pose(which))
            self._read(probe, mover.pose(which))

    def _conclude(self) -> None:
        """Turn all that was seen into facts."""
        self._read_firmware()
        version = self.table.find_role("version")
        firmware = self.firmware.get(version.name, "") if version else ""
        self.mistakes = self._interpreter.add_readings(
            self._checks, self._snapshots, self._evidence
        )
        position_known = not any(_is_place(self.table, mistake) for mistake in self.mistakes)
        self._interpreter.add_results(self._results, position_known=position_known)
        self._interpreter.add_silence(f" {firmware}" if firmware else "")
        self._interpreter.add_acknowledgements()

    def _read_firmware(self) -> None:
        rows = dict(entry for snapshot in self._snapshots for entry in snapshot.items())
        for source in sources(self.table):
            if _is_version(source) and source.key in rows:
                self.firmware[source.query.name] = ".".join(f"{v:g}" for v in rows[source.key])


def states(command: Command) -> tuple[str, ...]:
    """Return the names of what a query reports, as state and as field."""
    effect = effect_of(command)
    named = tuple(effect.values.values()) if isinstance(effect, Reports) else ()
    return (*named, *(field.name for variant in command.reply for field in variant.fields))


def _decides(step: Step) -> str:
    """Return the aspect of the fact that a step decides; a step with a decided fact is skipped."""
    return "present" if step.group is queries.QUERIES else "effect"


def _is_version(source: Source) -> bool:
    return source.query.role == "version" or source.state.endswith(("version", "revision"))


def _is_place(table: Table, mistake: Mistake) -> bool:
    """Return whether a mistake is about where the arm is, or where it is sent."""
    commands = {table.command(command) for command, _ in mistake.keys}
    return any(command.role in ("joints", "coordinates", "joint targets") for command in commands)
