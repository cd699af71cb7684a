"""Find the mistake that explains contradictory readings, and the mistakes that they exclude.

A hypothesis is a possible mistake of the edition, such as tenths taken for hundredths, with the
correction of the readings. It explains the readings if all relations hold once they are corrected.
If the relations hold for the edition as it is, and each hypothesis about an aspect breaks one, that
aspect is confirmed.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import combinations
from math import pi
from typing import Any, NamedTuple

from cobotwire.inspect.readings import Key, Relation, Row, Snapshot, relations, sources, target_of
from cobotwire.protocol.numbers import Number
from cobotwire.protocol.table import Table

FACTORS = (10.0, 0.1, 100.0, 0.01)
FRACTIONS = {1: "whole units", 10: "tenths", 100: "hundredths", 1000: "thousandths"}
# Longer rows, such as registers, are not taken for joints.
MOST_JOINTS = 14
# How many mistakes of one arm are looked for.
MOST = 6


class Hypothesis(NamedTuple):
    """A mistake about an aspect of a reading; ``correct`` corrects a reading."""

    aspect: str
    text: str
    correct: Callable[[Row], Row]


class Mistake(NamedTuple):
    """A mistake in readings: the aspect, the readings, and the relations that show it."""

    aspect: str
    keys: tuple[Key, ...]
    text: str
    relations: tuple[Relation, ...]


def hypotheses(numbers: Sequence[Number]) -> Iterator[Hypothesis]:
    """Yield the mistakes that can be made about a row, likely ones first."""
    joints = len(numbers) if len(numbers) <= MOST_JOINTS else 0
    if any(number.unit for number in numbers):
        for factor in FACTORS:
            yield Hypothesis("scale", _scale_text(numbers[0], factor), _times(1 / factor))
    if {number.unit for number in numbers} == {"degree"}:
        text = "the readings are the expected values in radians, not in degrees"
        yield Hypothesis("unit", text, _times(180 / pi))
    if any(number.minimum < 0 and number.unit != "tick" for number in numbers):
        for at in range(joints):
            text = f"number {at + 1} of the row has the other sign"
            yield Hypothesis("sign", text, _negated(range(at, at + 1)))
        yield Hypothesis("sign", "all numbers have the other sign", _negated(range(joints)))
    orders = list(range(joints))
    for a, b in combinations(orders, 2):
        text = f"numbers {a + 1} and {b + 1} of the row are swapped"
        yield Hypothesis(
            "order", text, _ordered([b if i == a else a if i == b else i for i in orders])
        )
    if joints > 2:
        text = "the row is in reverse order"
        yield Hypothesis("order", text, _ordered(orders[::-1]))
        for by, side in ((1, "later"), (-1, "earlier")):
            text = f"each number of the row stands one position {side} than stated"
            yield Hypothesis("order", text, _ordered([(i + by) % joints for i in orders]))
    if any(n.width > 1 and n.encoding == "integer" and not n.bits for n in numbers):
        text = "the bytes of each number are in the other order (endianness)"
        yield Hypothesis("byte-order", text, lambda row: tuple(map(_other_bytes, numbers, row)))


def doubts(table: Table, results: Mapping[str, Any]) -> list[str]:
    """Return the mistakes that explain what an arm at rest replied; ``results`` are by query.

    If no mistake explains them, the result is empty: the arm may use another reference frame.
    """
    row: dict[Key, Row] = {}
    for source in sources(table):
        value = results.get(source.query.name)
        if source.of_joint or len(source.query.reply[0].fields) > 1 or value is None:
            continue
        row[source.key] = tuple(value) if source.field.many else (value,)
    moving = table.find_role("moving")
    if moving is not None and results.get(moving.name):
        return []
    checks = CrossChecks(table)
    frames = {key: (0.0,) for key in checks.conditions}
    found = checks.mistakes([{**frames, **row}])
    named = (each for each in found if each.aspect not in ("agreement", "limits"))
    return [f"{_names(each.keys)}: {each.text}" for each in named]


class CrossChecks:
    """Checks readings of an arm by the relations that the edition states."""

    def __init__(self, table: Table) -> None:
        self._numbers = {source.key: source.numbers for source in sources(table)}
        self._numbers |= [target] if (target := target_of(table)) else []
        self._relations = relations(table)
        self._ids = {command.name: command.id for command in table.commands}

    @property
    def keys(self) -> set[Key]:
        """The readings that are compared with anything."""
        return {key for r in self._relations for key in (*r.keys, *r.conditions)}

    @property
    def conditions(self) -> set[Key]:
        """The readings that decide whether a relation applies."""
        return {key for relation in self._relations for key in relation.conditions}

    @cached_property
    def _hypotheses(self) -> dict[Key, list[Hypothesis]]:
        return {key: list(hypotheses(numbers)) for key, numbers in self._numbers.items()}

    def mistakes(self, snapshots: Sequence[Snapshot]) -> list[Mistake]:
        """Return the mistakes that explain readings, then the readings that no mistake explains."""
        rows, found = [dict(snapshot) for snapshot in snapshots], list[Mistake]()
        while (broken := self._broken(rows, self._relations)) and len(found) < MOST:
            best = self._best(rows, broken)
            if not best:
                break
            found.append(self._mistake(best, broken, {key for row in rows for key in row}))
            for subject, hypothesis in best[:1]:
                rows = [_corrected(row, subject, hypothesis) for row in rows]
        for relation in self._broken(rows, self._relations):
            row = next(row for row in snapshots if relation.fails(row))
            readings = (f"{'.'.join(key)} is {_short(row[key])}" for key in relation.keys)
            text = f"{'; '.join(readings)}"
            found.append(Mistake(relation.aspect, relation.keys, text, (relation,)))
        return found

    def confirmed(self, snapshots: Sequence[Snapshot]) -> Iterator[tuple[Key, str]]:
        """Yield the confirmed aspects of readings: any mistake would break a relation."""
        wrong = {
            key for relation in self._broken(snapshots, self._relations) for key in relation.keys
        }
        for key in self._numbers:
            own = [r for r in self._relations if key in r.keys and r.independent]
            if key in wrong or not any(key in snapshot for snapshot in snapshots):
                continue
            excluded: dict[str, list[bool]] = {}
            for each in self._hypotheses[key] if own else ():
                verdicts = excluded.setdefault(each.aspect, [])
                # One mistake that is not excluded leaves the aspect open: skip the rest.
                if all(verdicts):
                    changed = [_corrected(row, (key,), each) for row in snapshots]
                    verdicts.append(any(self._broken(changed, own)))
            yield from ((key, aspect) for aspect, verdicts in excluded.items() if all(verdicts))
            if any(
                self._applies(r, row) for r in self._relations for row in snapshots if key in r.keys
            ):
                yield key, "agreement"

    def _applies(self, relation: Relation, row: Snapshot) -> bool:
        return len(relation.keys) > 1 and all(key in row for key in relation.keys)

    def _broken(self, rows: Sequence[Snapshot], among: Sequence[Relation]) -> list[Relation]:
        return [relation for relation in among if any(map(relation.fails, rows))]

    def _best(
        self, rows: Sequence[Snapshot], broken: list[Relation]
    ) -> list[tuple[tuple[Key, ...], Hypothesis]]:
        """Return the explanations that repair most relations by changing the fewest readings."""
        best, most = list[tuple[tuple[Key, ...], Hypothesis]](), (0, 0)
        for subject in self._subjects(broken):
            own = [r for r in self._relations if {*subject} & {*r.keys}]
            # Commands with one id have one reading.
            size = len({self._ids[name] for name, _ in subject})
            shown = [relation for relation in own if relation in broken]
            repaired = len(shown), -size
            if repaired < most:
                continue
            exact = any(relation.exact for relation in shown)
            for each in self._hypotheses[subject[0]]:
                if not exact and each.aspect in ("sign", "order"):
                    continue
                if not self._broken([_corrected(row, subject, each) for row in rows], own):
                    best, most = (best if repaired == most else []) + [(subject, each)], repaired
                    break
        return best

    def _subjects(self, broken: list[Relation]) -> list[tuple[Key, ...]]:
        """Return sets of readings that may be wrong: of one id, or all that are encoded alike.

        Several commands may have the same id, and name its reply in different ways.
        """
        involved = {key for relation in broken for key in relation.keys}
        groups: dict[object, list[Key]] = {}
        for key in self._numbers:
            of_id = self._ids[key[0]], key[1].partition(".")[0], self._alike(key)
            groups.setdefault(of_id, []).append(key)
        for key in self._numbers:
            groups.setdefault(self._alike(key), []).append(key)
        groups = {name: keys for name, keys in groups.items() if involved & {*keys}}
        return list(dict.fromkeys(map(tuple, groups.values())))

    def _alike(self, key: Key) -> tuple[object, ...]:
        return tuple((number.unit, number.divide) for number in self._numbers[key])

    def _mistake(
        self,
        best: list[tuple[tuple[Key, ...], Hypothesis]],
        broken: list[Relation],
        read: Container[Key],
    ) -> Mistake:
        """Name the mistake.

        If several explanations are equally good, name all of them.
        """
        found = [([key for key in subject if key in read], h) for subject, h in best]
        texts = [h.text for _, h in found]
        if len(found) > 1:
            texts = [f"{_names(subject)}: {h.text}" for subject, h in found]
        keys = tuple(dict.fromkeys(key for subject, _ in found for key in subject))
        shown = tuple(r for r in broken if {*keys} & {*r.keys})
        aspect = best[0][1].aspect if len(best) == 1 else "agreement"
        return Mistake(aspect, keys, "; or ".join(texts), shown)


def _corrected(row: Snapshot, subject: Sequence[Key], hypothesis: Hypothesis) -> dict[Key, Row]:
    return {**row, **{key: hypothesis.correct(row[key]) for key in subject if key in row}}


def _names(keys: Sequence[Key]) -> str:
    return ", ".join(f"{command} {part}" for command, part in keys)


def _short(row: Row) -> str:
    return ", ".join(f"{value:.6g}" for value in row)


def _scale_text(number: Number, factor: float) -> str:
    text = f"the readings are {factor:g} x the expected values"
    stated = number.divide / number.multiply
    sent = stated * factor
    names = [FRACTIONS.get(round(each)) for each in (sent, stated)]
    if all(names) and sent >= 1:
        text += f": the arm sends {names[0]}, the edition states {names[1]}"
    return text


def _times(factor: float) -> Callable[[Row], Row]:
    return lambda row: tuple(value * factor for value in row)


def _negated(which: range) -> Callable[[Row], Row]:
    return lambda row: tuple(-v if at in which else v for at, v in enumerate(row))


def _ordered(order: Sequence[int]) -> Callable[[Row], Row]:
    return lambda row: tuple(row[at] for at in order)


def _other_bytes(number: Number, value: float) -> float:
    raw = round(number.steps(value))
    return number.physical(number.unpack(number.pack(raw)[::-1]))
