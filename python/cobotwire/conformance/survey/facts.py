"""The facts of an edition about an arm, and what a survey finds about each."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple

from cobotwire.conformance.report import Exchange
from cobotwire.protocol.effects import effect_of
from cobotwire.protocol.table import Command, Field, Table

# What can be stated about a command, its request, its reply or a field.
ASPECTS = {
    "present": "the firmware has the command",
    "deadline": "the reply comes in time",
    "effect": "the command does what is stated",
    "id": "the reply has the stated id",
    "length": "the reply has the stated length",
    "scale": "the raw values count the stated fraction of the unit",
    "unit": "the values have the stated unit",
    "sign": "values grow in the stated direction",
    "order": "the numbers stand in the stated order",
    "byte-order": "the bytes of a number stand in the stated order",
    "range": "the edition allows all values",
    "limits": "the joints have the stated limits",
    "agreement": "the values agree with those of other commands",
}
Found = Literal["confirmed", "contradicted", "not seen"]
NOT_SEEN = "No reading of this survey shows it."
# How many exchanges a fact keeps.
MOST_FRAMES = 3
# How many bytes of a frame it keeps; any frame is shorter, but noise can be longer.
MOST_BYTES = 300


class Frames(NamedTuple):
    """A request, and what was received after it."""

    sent: bytes
    received: bytes


@dataclass
class Fact:
    """One fact, and what the survey has found about it."""

    fact: str
    verdict: Found = "not seen"
    why: str = NOT_SEEN
    frames: tuple[Frames, ...] = ()

    def as_json(self) -> dict[str, object]:
        """Return the fact as the file holds it."""
        pairs = (f._asdict().items() for f in self.frames)
        frames = [{k: data[:MOST_BYTES].hex(" ").upper() for k, data in pair} for pair in pairs]
        return {"fact": self.fact, "verdict": self.verdict, "why": self.why, "frames": frames}


class Facts(dict[str, Fact]):
    """All facts that a survey can show, by name; a contradiction is never replaced."""

    def __init__(self, table: Table) -> None:
        self._edition = table.edition
        names = (self.name(*key) for command in table.commands for key in _stated(command))
        super().__init__((name, Fact(name)) for name in names)

    def name(self, command: str, part: str, aspect: str) -> str:
        """Return the name of a fact."""
        assert aspect in ASPECTS, aspect
        return f"{self._edition}/{command}/{part}/{aspect}"

    def note(
        self,
        key: tuple[str, str, str],
        verdict: Found,
        why: str,
        frames: Iterable[Frames] = (),
    ) -> None:
        """Note what was found about a fact; a contradiction replaces a confirmation."""
        name = self.name(*key)
        old = self.setdefault(name, Fact(name))
        if old.verdict == "not seen" or (verdict == "contradicted" and old.verdict == "confirmed"):
            self[name] = Fact(name, verdict, why, tuple(frames)[:MOST_FRAMES])

    def with_verdict(self, verdict: Found) -> list[Fact]:
        """Return the facts with a verdict."""
        return [fact for fact in self.values() if fact.verdict == verdict]


def _stated(command: Command) -> Iterator[tuple[str, str, str]]:
    """Yield what the edition states of a command, as far as an arm can show it."""
    if command.event:
        return
    of_command = ["present", "deadline"] if command.requires_reply else []
    effect = effect_of(command)
    of_command += ["effect"] if effect is not None and not effect.assumed else []
    of_reply = ["id", "length"] if command.reply else []
    yield from ((command.name, "command", aspect) for aspect in of_command)
    yield from ((command.name, "reply", aspect) for aspect in of_reply)
    for part, variants in (("request", command.request), ("reply", command.reply)):
        # If several variants have a field, the longest one decides, as in the generator.
        longest = sorted(variants, key=lambda variant: -len(variant.fields))
        fields = {field.name: field for variant in reversed(longest) for field in variant.fields}
        for field in fields.values():
            if field.const is None and not field.echo:
                yield from ((command.name, f"{part}.{field.name}", a) for a in _aspects(field))


def _aspects(field: Field) -> Iterator[str]:
    """Yield what is stated about a field; the generator counts the same (its ``facts.py``)."""
    if field.kind in ("bytes", "text"):
        return
    numbers = [number for case in field.cases for number in case.numbers]
    if any(n.choices or (n.minimum, n.maximum) != n.raw_range for n in numbers):
        yield "range"
    if any(number.scaled or number.unit for number in numbers):
        yield "scale"
    if any(number.unit for number in numbers):
        yield "unit"
    if any(number.minimum < 0 for number in numbers):
        yield "sign"
    if any(len(case.numbers) > 1 for case in field.cases):
        yield "order"
    if any(number.width > 1 for number in numbers):
        yield "byte-order"


def frames_of(evidence: Iterable[Exchange]) -> list[Frames]:
    """Return each request of the evidence with what was received until the next one."""
    found: list[Frames] = []
    for each in evidence:
        if each.direction == "sent":
            found.append(Frames(each.data, b""))
        elif found:
            found[-1] = Frames(found[-1].sent, found[-1].received + each.data)
    return found
