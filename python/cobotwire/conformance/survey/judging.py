"""Turn the verdicts of test cases, and the readings of an arm, into facts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from cobotwire import codec as codecs
from cobotwire.conformance.device.device import Device
from cobotwire.conformance.report import Result, Verdict
from cobotwire.conformance.survey.facts import Facts, Found, Frames, frames_of
from cobotwire.inspect.cross_checks import CrossChecks, Mistake
from cobotwire.inspect.readings import Key, Snapshot
from cobotwire.protocol.printable import printable
from cobotwire.protocol.table import Command, Table

# The facts that each test case shows.
SHOWN = {
    "query-replied": (("command", "present"), ("command", "deadline")),
    "reply-frame": (("reply", "id"), ("reply", "length")),
    **dict.fromkeys(
        ("read-back", "set-is-reported", "reference-shifts", "reached", "arrives", "stops", "moving"),
        (("command", "effect"),),
    ),
    "agrees": (("reply", "agreement"),),
}
# The test cases that judge by where the arm is.
BY_PLACE = ("reached", "arrives", "stops", "moving", "agrees")
# Text of this length in a reply's place is what a device says instead.
WORDS = 8
# An argument that all silent commands share, if so many are silent, is what is wrong.
SEVERAL = 2


class Judge:
    """Fills the facts from what a survey has seen."""

    def __init__(self, table: Table, device: Device, facts: Facts) -> None:
        self._table, self._device, self.facts = table, device, facts
        self._silent: dict[str, list[Frames]] = {}

    def judge_results(self, results: Sequence[Result], *, place_known: bool) -> None:
        """Note what the verdicts show.

        ``place_known`` is whether what the arm reports of its place is right: otherwise no command
        is judged by it.
        """
        for result in results:
            frames = frames_of(result.evidence)
            by_place = result.case in BY_PLACE and not place_known
            if result.verdict is Verdict.PASS and not by_place:
                for part, aspect in SHOWN.get(result.case, ()):
                    self._note(result.command, part, aspect, "confirmed", result.reason, frames)
            elif result.verdict is Verdict.FAIL and not by_place:
                self._judge_failure(result, frames)

    def _judge_failure(self, result: Result, frames: list[Frames]) -> None:
        command = self._table.command(result.command)
        part, aspect = SHOWN.get(result.case, (("", ""),))[0]
        if result.case == "query-replied":
            if any(frame.received for frame in frames) and "ms" in result.reason.partition(";")[2]:
                aspect = "deadline"
            elif words := _words(frames):
                why = f"The device says instead of a reply: {words}"
                return self._note(command.name, part, "present", "not seen", why, frames)
            else:
                self._silent[command.name] = frames
                return None
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
        """Return whether a whole frame came that has another id than the command's."""
        frame = self._table.frame
        if not frame.reply_has_id:
            return False
        framer = codecs.load(self._table).framer("reply")
        received = b"".join(each.received for each in frames)
        events = [*framer.feed(received), *framer.flush()]
        ids = {getattr(event, "command", command.id) for event in events}
        return bool(ids - {command.id})

    def judge_silence(self, firmware: str) -> None:
        """Note which commands have no reply, and what they have in common."""
        replied = self._device.noticed.reply_seconds
        silent = [self._table.command(name) for name in self._silent]
        for argument in dict.fromkeys(f.name for c in silent for f in c.request[0].fields):
            alike = [c for c in silent if _takes(c, argument) and c.name in self._silent]
            others = [c for c in self._table.commands if c.name in replied and _takes(c, argument)]
            if len(alike) < SEVERAL or others:
                continue
            why = (
                f"No command with the argument {argument} has a reply, all others have: the "
                f"device has another {argument} than those that were sent."
            )
            for command in alike:
                frames = self._silent.pop(command.name)
                place = command.name, f"request.{argument}", "range"
                self.facts.note(place, "contradicted", why, frames)
        for name, frames in self._silent.items():
            more = len(self._silent) - 1
            also = f", nor have {more} other commands" if more else ""
            why = (
                f"The command has no reply{also}: the firmware{firmware} lacks it, or has it "
                "under another id."
            )
            self._note(name, "command", "present", "contradicted", why, frames)

    def judge_acknowledgements(self) -> None:
        """Note acknowledgements that came in time, and those that came later."""
        for name, response in self._device.noticed.acknowledged.items():
            command = response.request.command
            if not response.replies or command.safety == "motion":
                continue
            took, deadline = response.replies[0].seconds * 1000, command.deadline_ms
            verdict: Found = "confirmed" if took <= deadline else "contradicted"
            why = f"The acknowledgement took {took:.0f} of {deadline} ms."
            frames = [Frames(response.request.frame, response.replies[0].data)]
            self._note(name, "command", "deadline", verdict, why, frames)

    def judge_readings(
        self,
        checks: CrossChecks,
        snapshots: Sequence[Snapshot],
        evidence: Mapping[Key, list[Frames]],
    ) -> list[Mistake]:
        """Compare the readings with each other; return the mistakes that they show."""
        mistakes = checks.mistakes(snapshots)
        for mistake in mistakes:
            shows = "; ".join(dict.fromkeys(relation.text for relation in mistake.relations))
            frames = [frame for key in mistake.keys for frame in evidence.get(key, [])]
            frames += [f for r in mistake.relations for k in r.keys for f in evidence.get(k, [])]
            for command, part in mistake.keys:
                why = f"{mistake.text}. It does not hold that {shows}."
                self._note(command, part, mistake.aspect, "contradicted", why, dict.fromkeys(frames))
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
