"""Turn the verdicts of test cases, and the readings of an arm, into facts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Frame
from cobotwire.conformance.device.device import Device
from cobotwire.conformance.device.tester import is_silence
from cobotwire.conformance.report import Result, Verdict
from cobotwire.conformance.survey.facts import Facts, Found, Frames, frames_of
from cobotwire.inspect.cross_checks import CrossChecks, Mistake
from cobotwire.inspect.readings import Key, Snapshot
from cobotwire.protocol.printable import printable
from cobotwire.protocol.table import Command, Direction, Table

# The facts that each test case shows.
SHOWN = {
    "query-replied": (("command", "present"), ("command", "deadline")),
    "reply-frame": (("reply", "id"), ("reply", "length")),
    **dict.fromkeys(
        (
            "read-back",
            "set-is-reported",
            "reference-shifts",
            "reached",
            "arrives",
            "stops",
            "moving",
        ),
        (("command", "effect"),),
    ),
    "agrees": (("reply", "agreement"),),
}
# The test cases that depend on the reported position of the arm.
BY_POSITION = ("reached", "arrives", "stops", "moving", "agrees")
# Text of at least this length instead of a reply counts as an error message of the device.
WORDS = 8
# A reason lists at most this many relations that do not hold.
MOST_SHOWN = 3
# If at least this many commands without a reply share an argument, its value must be wrong.
SEVERAL = 2


def ids_of(codec: Codec, direction: Direction, data: bytes) -> set[int]:
    """Return the ids of the frames in some bytes."""
    framer = codec.framer(direction)
    return {e.command for e in (*framer.feed(data), *framer.flush()) if isinstance(e, Frame)}


class Interpreter:
    """Turns what a survey has seen into facts."""

    def __init__(self, table: Table, device: Device, facts: Facts) -> None:
        self._table, self._device, self.facts = table, device, facts
        self._codec = codecs.load(table)
        self._silent: dict[str, list[Frames]] = {}
        # Observations that decide no fact, but that a person should read.
        self.questions: list[str] = []

    def add_results(self, results: Sequence[Result], *, position_known: bool) -> None:
        """Add what the verdicts show.

        ``position_known`` is whether the position that the arm reports is right. Otherwise verdicts
        that depend on it are left out.
        """
        for result in results:
            frames = frames_of(result.evidence)
            by_position = result.case in BY_POSITION and not position_known
            if result.verdict is Verdict.PASS and not by_position:
                for part, aspect in SHOWN.get(result.case, ()):
                    self._note(result.command, part, aspect, "confirmed", result.reason, frames)
            elif result.verdict is Verdict.FAIL and not by_position:
                self._add_failure(result, frames)

    def _add_failure(self, result: Result, frames: list[Frames]) -> None:
        command = self._table.command(result.command)
        part, aspect = SHOWN.get(result.case, (("", ""),))[0]
        if result.case == "query-replied":
            if result.reason.partition("; ")[2].startswith("the reply came after"):
                aspect = "deadline"
            elif command.name in self._device.noticed.reply_seconds:
                why = f"It was replied to, but not each time: {result.reason}"
                return self._note(command.name, part, aspect, "confirmed", why, frames)
            elif words := _words(frames):
                why = f"Instead of a reply, the device sends: {words}"
                self.questions.append(f"{command.name}: {why}")
                return self._note(command.name, part, "present", "not seen", why, frames)
            else:
                # The frames may include a later query and its reply: choose those of this command.
                own = [f for f in frames if command.id in ids_of(self._codec, "request", f.sent)]
                if not any(frame.received for frame in own):
                    self._silent[command.name] = own
                return None
        elif command.name not in self._device.noticed.reply_seconds and is_silence(result):
            return None  # ``query-replied`` reports it.
        elif result.case == "reply-frame":
            aspect = "id" if self._has_other_id(command, frames) else "length"
        elif result.case == "reply-fields":
            fields = [f.name for variant in command.reply for f in variant.fields]
            named = [name for name in fields if f"; {name} " in result.reason]
            part, aspect = f"reply.{(named or fields)[0]}", "range"
        if part:
            self._note(command.name, part, aspect, "contradicted", result.reason, frames)
        return None

    def _has_other_id(self, command: Command, frames: Sequence[Frames]) -> bool:
        """Return whether a whole frame with another id than the command's was received."""
        received = b"".join(frame.received for frame in frames)
        ids = ids_of(self._codec, "reply", received)
        return self._table.frame.reply_has_id and bool(ids - {command.id})

    def add_silence(self, firmware: str) -> None:
        """Add which commands have no reply, and the argument that they have in common."""
        replied = self._device.noticed.reply_seconds
        silent = [self._table.command(name) for name in self._silent]
        for argument in dict.fromkeys(f.name for c in silent for f in c.request[0].fields):
            alike = [c for c in silent if _takes(c, argument) and c.name in self._silent]
            others = [c for c in self._table.commands if c.name in replied and _takes(c, argument)]
            if len(alike) < SEVERAL or others:
                continue
            why = (
                f"No command with the argument {argument} has a reply: the arm has another "
                f"{argument} than those that were sent, or none."
            )
            self.questions.append(f"{', '.join(c.name for c in alike)}: {why}")
            for command in alike:
                self._note(
                    command.name,
                    "command",
                    "present",
                    "not seen",
                    why,
                    self._silent.pop(command.name),
                )
        for name, frames in self._silent.items():
            more = len(self._silent) - 1
            also = f", nor have {more} other commands" if more else ""
            why = (
                f"The command has no reply{also}: the firmware{firmware} lacks it, or has it "
                "under another id."
            )
            self._note(name, "command", "present", "contradicted", why, frames)

    def add_acknowledgements(self) -> None:
        """Add which acknowledgements came in time, and which came late."""
        for name, response in self._device.noticed.acknowledged.items():
            command = response.request.command
            if not response.replies or command.safety == "motion":
                continue
            took, deadline = response.replies[0].seconds * 1000, command.deadline_ms
            verdict: Found = "confirmed" if took <= deadline else "contradicted"
            why = f"The acknowledgement took {took:.0f} of {deadline} ms."
            frames = [Frames(response.request.frame, response.replies[0].data)]
            self._note(name, "command", "deadline", verdict, why, frames)

    def add_readings(
        self,
        checks: CrossChecks,
        snapshots: Sequence[Snapshot],
        evidence: Mapping[Key, list[Frames]],
    ) -> list[Mistake]:
        """Compare the readings with each other; return the mistakes that they show."""
        mistakes = checks.mistakes(snapshots)
        for mistake in mistakes:
            broken = list(dict.fromkeys(relation.text for relation in mistake.relations))
            more = f"; and {len(broken) - MOST_SHOWN} more" if len(broken) > MOST_SHOWN else ""
            shows = "; ".join(broken[:MOST_SHOWN]) + more
            frames = [frame for key in mistake.keys for frame in evidence.get(key, [])]
            frames += [f for r in mistake.relations for k in r.keys for f in evidence.get(k, [])]
            for command, part in mistake.keys:
                why = f"{mistake.text}. Contradicted: {shows}."
                self._note(
                    command, part, mistake.aspect, "contradicted", why, dict.fromkeys(frames)
                )
        for (command, part), aspect in checks.confirmed(snapshots):
            why = "Other readings fit only if this is right."
            if aspect == "agreement":
                why = "Other readings of the state agree."
            frames = evidence.get((command, part), [])
            self._note(command, part, aspect, "confirmed", why, frames)
        return mistakes

    def _note(
        self,
        command: str,
        part: str,
        aspect: str,
        verdict: Found,
        why: str,
        frames: Iterable[Frames],
    ) -> None:
        self.facts.note((command, part, aspect), verdict, printable(why), frames)


def _takes(command: Command, argument: str) -> bool:
    return any(field.name == argument for field in command.request[0].fields)


def _words(frames: Sequence[Frames]) -> str:
    """Return the text that a device sends instead of a reply; empty if it sends none."""
    for frame in frames[::-1]:
        text = frame.received.strip(b"\0\r\n").decode("ascii", errors="replace")
        if len(text) >= WORDS and text.isprintable() and text.isascii():
            return text[:120]
    return ""
