"""A whole run: every group for every command that the permissions allow, and a report."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

from cobotwire import codec as codecs
from cobotwire.conformance.device.connection import DeviceConnection
from cobotwire.conformance.device.device import (
    Device,
    EnoughFailures,
    NoMoreReplies,
    NotSupported,
)
from cobotwire.conformance.device.groups.changes import AFTER_CHANGE_OR_REPLY
from cobotwire.conformance.device.groups.recorded import taken
from cobotwire.conformance.device.permissions import Permissions
from cobotwire.conformance.device.plan import RAN, Plan, Step
from cobotwire.conformance.device.probe import Probe, Run, needed
from cobotwire.conformance.device.read_as import sent_last
from cobotwire.conformance.device.requester import Timing
from cobotwire.conformance.device.suite import SUITE
from cobotwire.conformance.report import Cause, Report, Result, Verdict
from cobotwire.conformance.statement import Statement
from cobotwire.conformance.tally import Tally, merged
from cobotwire.protocol.addresses import find_address
from cobotwire.protocol.errors import LinkError, UsageError
from cobotwire.protocol.table import Command, Table

# From this angle on, a joint shows a wrong scale, order or direction; in degrees.
AWAY = 5.0
# A reason contains one of these if no valid reply to a query was received. A second query may still
# have had a reply.
SILENCE = ("received nothing", "received no valid reply", "received noise ")

Progress = Callable[[Step, int, int], None]


def is_silence(result: Result) -> bool:
    """Return whether a verdict says that no valid reply came."""
    return any(words in result.reason for words in SILENCE)


class Tester:
    """Tests the device at the other end of a connection against an edition."""

    # pytest would take the class for a class of tests.
    __test__ = False

    def __init__(
        self,
        connection: DeviceConnection,
        table: Table,
        *,
        permissions: Permissions | None = None,
        sources: Mapping[str, str] | None = None,
        timing: Timing | None = None,
        repeat: int = 1,
        retries: int = 0,
        optional: frozenset[str] = frozenset(),
        address: int | str | None = None,
        statement: Statement | None = None,
        lacking: Mapping[str, str] | None = None,
    ) -> None:
        """Prepare a run; nothing is sent.

        Args:
            connection: the connection to the device.
            table: the edition that the device must conform to.
            permissions: what may be sent in addition to queries; left out: nothing.
            sources: where the spec defines each command, by name.
            timing: how long the tester listens.
            repeat: how often each body is run; if the runs differ, the verdict is unstable.
            retries: how often a query is repeated if nothing comes.
            optional: commands that the device may lack: if it is silent, they are not supported.
            address: the device's address, by number or name; left out: the edition's first one.
            statement: what the maker declares of the device; it selects test cases, and is tested.
            lacking: the commands that the device itself reports as unsupported, each with the
                reason; more may be added during the run. Silence is no failure of these.

        Raises:
            UsageError: the edition has no such address, or a request to it has no reply.
        """
        device_address = find_address(table, address)
        if device_address is not None and device_address.replies == "none":
            raise UsageError("address", device_address.name, "one that has replies (--address)")
        self.connection = connection
        self.table = table
        self._repeat = repeat
        self._statement = statement or Statement()
        self._optional = optional | self._statement.optional
        self._lacking: Mapping[str, str] = {} if lacking is None else lacking
        self._sources = sources
        # Why the run ends early; empty if it does not.
        self._ended = ""
        self.device = Device(
            connection,
            codecs.load(table),
            permissions=permissions or Permissions(),
            timing=timing or Timing(),
            retries=retries,
            address=device_address,
            statement=self._statement,
            optional=self._optional,
        )
        self._run = Run(self.device)
        at = "" if device_address is None else f" at address {device_address.name}"
        self.report = Report("device", table.edition, f"{connection.name}{at}")
        self.report.statement = self._statement.text
        self.report.reply_seconds = self.device.noticed.reply_seconds
        self.report.deadline_seconds = {c.name: c.deadline_ms / 1000 for c in table.commands}

    def steps(self) -> Iterator[Step]:
        """Yield the steps in the order of a run."""
        for group in SUITE.groups:
            if group.declared and not self._statement.is_declared:
                continue
            if group.selects is None:
                yield Step(group, None)
                continue
            absent = self._statement.absent(self.table)
            for command in absent if group.declared else self.table.commands:
                # Nothing is sent for an event.
                if not command.event and group.selects(self.table, command):
                    yield Step(group, command)

    def _own(self, command: Command) -> Command | None:
        """Return a command without references to commands that the device lacks.

        None if it lacks this one.
        """
        return next((c for c in self.device.table.commands if c.name == command.name), None)

    def run(self, progress: Progress | None = None, plan: Plan | None = None) -> Report:
        """Run everything that is permitted; restore all changes, however the run ends.

        Test cases that are not run because the run ends early are reported as not run. ``plan``
        takes the order, and perhaps results, from an earlier report; left out: everything is run.

        Raises:
            LinkError: the connection is lost; the report holds what was found until then.
        """
        plan = plan or Plan()
        steps = plan.ordered(list(self.steps()))
        done = 0
        try:
            self._read_version()
            self._note_zero()
            for step in steps:
                if progress is not None:
                    progress(step, done, len(steps))
                self.report.results += plan.results(step) or self.results(step)
                done += 1
                if self._ended:
                    break
        except KeyboardInterrupt:
            self._ended = "the run was interrupted"
            self._halt()
            raise
        except LinkError as error:
            self._ended = f"{error}; {sent_last(self.table, self.connection.last_sent())}"
            raise
        finally:
            self._close(steps[done:])
            self._note_unread()
            self.report.seconds = self.connection.now
        self.report.finished = not self._ended
        return self.report

    def _close(self, left: list[Step]) -> None:
        """Restore what was changed, and report what was not run."""
        try:
            self.end()
        finally:
            self.report.stopped = self._ended
            for step in left:
                self.report.results += self.results_without_run(step)

    def end(self) -> None:
        """Restore changes that are left, then those made for the whole run: power and pose.

        An interrupt also stops an arm that is on its way back.
        """
        try:
            self.device.restore_after_body.run()
            self.device.restore_at_end.run()
        except KeyboardInterrupt:
            self._halt()
            self.device.restore_after_body.run()
            raise

    def missing(self, step: Step) -> str:
        """Return the permissions that a step needs and the run lacks; empty if it lacks none."""
        return self.device.permissions.missing(needed(step.group, step.command))

    def results(self, step: Step) -> list[Result]:
        """Run one step as often as the run repeats steps."""
        if self._obstacle(step) or self._ended:
            return self.results_without_run(step)
        found = merged([self._run_once(step) for _ in range(self._repeat)])
        return [replace(result, group=step.group.name) for result in found]

    def results_without_run(self, step: Step) -> list[Result]:
        """Return the results of a step that is not selected or permitted, or was not reached."""
        obstacle = self._obstacle(step) or (Cause.RUN_ENDED, f"{self._ended}.")
        found = self._probe(step).without_verdict(*obstacle)
        return [replace(result, group=step.group.name) for result in found]

    def _obstacle(self, step: Step) -> tuple[Cause, str] | None:
        """Return why a step is not run: the statement deselects it, or it is not permitted."""
        deselected, missing = self._deselected(step), self.missing(step)
        if deselected:
            return Cause.NOT_SELECTED, deselected
        return (Cause.NOT_PERMITTED, f"It needs permission: {missing}.") if missing else None

    def _deselected(self, step: Step) -> str:
        """Return why the statement deselects a step; empty: it does not."""
        if step.command is None or step.group.declared:
            return ""
        reason, own = self._statement.deselected(step.command), self._own(step.command)
        if reason:
            return reason
        if own is None:
            return f"The device lacks {step.command.name}, which is optional."
        if step.group.selects and step.group.selects(self.device.table, own):
            return ""
        return "The device lacks another command, without which this cannot be observed."

    def _probe(self, step: Step) -> Probe:
        command = step.command and (self._own(step.command) or step.command)
        return Probe(self._run, step.group, command, Tally(self._sources))

    def _run_once(self, step: Step) -> list[Result]:
        probe = self._probe(step)
        unsupported = ""
        try:
            step.group.body(probe)
        except EnoughFailures:
            pass
        except NotSupported as reason:
            unsupported = str(reason)
        except NoMoreReplies as reason:
            unsupported = self._ended = str(reason)
        except UsageError as error:
            unsupported = f"the device reported a value that cannot be sent to it: {error}"
        except KeyboardInterrupt:
            self._halt()
            raise
        finally:
            self.device.restore_after_body.run()
        found = [self._excused(result) for result in probe.results(unsupported)]
        # A test case that had passed when the device fell silent may be incomplete.
        return [self._cut_short(result) for result in found] if self._ended else found

    def _excused(self, result: Result) -> Result:
        """Report silence as not supported, not as a failure, if the device may lack the command."""
        if result.verdict is not Verdict.FAIL:
            return result
        stated = self._lacking.get(result.command, "") if is_silence(result) else ""
        never = not self.device.noticed.reply_seconds.get(result.command)
        if not stated and not (never and result.command in self._optional):
            return result
        reason = f"The device states: {stated}." if stated else result.reason
        cause = Cause.NOT_SUPPORTED
        return replace(result, verdict=cause.verdict, cause=cause, reason=reason)

    def _cut_short(self, result: Result) -> Result:
        """Return a failure as it is, and anything else as not run."""
        if result.verdict is Verdict.FAIL:
            return result
        cause, reason = Cause.RUN_ENDED, f"{self._ended}."
        return replace(result, verdict=cause.verdict, cause=cause, reason=reason, evidence=())

    def _halt(self) -> None:
        """Stop the arm. An arm that has not come to rest is not sent back, and keeps its power."""
        for name in ("pose", "power"):
            self.device.restore_at_end.pop(name, None)
        stop = self.device.command("stop")
        if stop is not None and self.device.permissions.workspace:
            self.device.request(stop.request_type())

    def _note_zero(self) -> None:
        """Report which joints stand at zero, if none of them may move."""
        query = self.device.command("joints")
        if query is None or self.device.permissions.workspace:
            return
        reply = self.device.read(query.request_type())
        angles = () if reply is None else reply.result
        still = [str(at) for at, angle in enumerate(angles, 1) if abs(angle) < AWAY]
        if still:
            self.report.untested = (
                f"Not tested away from zero: joint {', '.join(still)}. At zero, a wrong scale, "
                "order or direction does not show; with --allow motion the arm is also tested "
                "elsewhere."
            )

    def _note_unread(self) -> None:
        """Report the commands that were sent, but have an effect that no query shows."""
        after = {case.id for case in AFTER_CHANGE_OR_REPLY}
        malformed = {group.name for group in SUITE.groups if "malformed" in group.permission}
        ran = [r for r in self.report.results if r.command and r.verdict in RAN]
        tested = {r.command for r in ran if r.case not in after and r.group not in malformed}
        sent = sorted({r.command for r in ran if r.case in after} - tested)
        unread = [name for name in sent if not taken(self.table, self.table.command(name))]
        if unread:
            text = f"Not tested: the effect of {', '.join(unread)}; only the response was checked."
            self.report.untested = f"{self.report.untested} {text}".strip()

    def _read_version(self) -> None:
        query = self.device.command("version")
        reply = None if query is None else self.device.read(query.request_type())
        if reply is not None:
            self.report.firmware = str(reply.result)
