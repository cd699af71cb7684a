"""Turns evidence files into observations, their vectors, and disputes about contradicted facts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from cobotwire_codegen import language
from cobotwire_codegen.build.parts import Parts
from cobotwire_codegen.build.vectors import build_vector
from cobotwire_codegen.errors import Problem
from cobotwire_codegen.language.words import CONFIDENCE
from cobotwire_codegen.load import Node
from cobotwire_codegen.model import (
    Dispute,
    Evidence,
    Family,
    Observation,
    ObservedFact,
    Vector,
)
from cobotwire_codegen.reader import Reader


def build_evidence(
    parts: Parts, problems: list[Problem]
) -> tuple[tuple[Observation, ...], list[Vector]]:
    """Return what arms showed, and the vectors of all files."""
    spec = language.EvidenceFile
    observed, vectors = [], []
    for node in parts.evidence:
        reader = Reader(node, spec, "the evidence file", problems)
        reader.get(spec.evidence)  # informs readers of the file
        seen = [build_vector(each, problems) for each in reader.get(spec.vectors)]
        arm = Observation(
            node.place,
            reader.get(spec.kind),
            reader.get(spec.robot),
            reader.get(spec.firmware),
            reader.get(spec.date),
            reader.get(spec.digest),
            tuple(_fact(each, problems) for each in reader.get(spec.facts)),
            tuple(vector.name for vector in seen),
        )
        observed.append(arm)
        vectors += [replace(vector, says=vector.says or arm.source) for vector in seen]
    return tuple(observed), vectors


def _fact(node: Node, problems: list[Problem]) -> ObservedFact:
    spec = language.ObservedFact
    reader = Reader(node, spec, "an observed fact", problems)
    confirmed = reader.get(spec.verdict) == "confirmed"
    named, why = reader.get(spec.fact), reader.get(spec.why)
    return ObservedFact(node.place, named, confirmed, why, reader.get(spec.frames))


# The evidence of arms for the facts of a command, by PART/ASPECT.
Seen = dict[str, list[tuple[Observation, ObservedFact]]]


def with_disputes(
    families: Sequence[Family], observed: Sequence[Observation]
) -> tuple[Family, ...]:
    """Return the families, each command with a dispute for each fact that an arm contradicts."""
    found: dict[str, Seen] = {}
    for each in observed:
        for fact in each.facts:
            command, _, name = fact.fact.partition("/")
            found.setdefault(command, {}).setdefault(name, []).append((each, fact))
    if not found:
        return tuple(families)
    return tuple(
        replace(
            family,
            commands=tuple(
                replace(each, disputed=tuple(_disputes(each.disputed, found.get(each.name, {}))))
                for each in family.commands
            ),
        )
        for family in families
    )


def _disputes(stated: Sequence[Dispute], found: Seen) -> Iterator[Dispute]:
    for dispute in stated:
        yield _weighed(dispute, found.get(dispute.about, []))
    known = {dispute.about for dispute in stated}
    for name, seen in found.items():
        place = next((fact.place for _, fact in seen if not fact.confirmed), None)
        if place is not None and name not in known:
            claim = f"{name} is as this edition states it."
            yield _weighed(Dispute(place, claim, "as stated", "medium", (), name), seen)


def _weighed(dispute: Dispute, seen: list[tuple[Observation, ObservedFact]]) -> Dispute:
    """Return a dispute with what arms showed, which raises or lowers the confidence."""
    levels = CONFIDENCE[::-1]
    balance = sum(1 if fact.confirmed else -1 for _, fact in seen)
    level = levels.index(dispute.confidence) + balance
    return replace(
        dispute,
        confidence=levels[min(max(level, 0), len(levels) - 1)],
        evidence=(
            *dispute.evidence,
            *(Evidence(arm.source, (), _says(fact)) for arm, fact in seen),
        ),
    )


def _says(fact: ObservedFact) -> str:
    verdict = "confirms this" if fact.confirmed else "contradicts this"
    why = f": {fact.why}" if fact.why else ""
    return f"{verdict}{why}{f' ({fact.frames[0]})' if fact.frames else ''}"
