"""Compares two editions, and two sets of editions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from cobotwire_codegen.diff import prose, words
from cobotwire_codegen.diff.commands import command_changes
from cobotwire_codegen.diff.families import family_changes
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.frame import frame_changes
from cobotwire_codegen.diff.named import named_types
from cobotwire_codegen.diff.robot import robot_changes
from cobotwire_codegen.diff.rules import LEVELS
from cobotwire_codegen.model import Edition

_SEVERITY = {level: index for index, level in enumerate(LEVELS)}


def diff(old: Edition, new: Edition) -> tuple[Finding, ...]:
    """Return the findings from one edition to another, each once, the most severe first.

    Places in files are not compared. The result is empty if and only if the editions are equal.
    """
    known, named = named_types(old, new)
    found = [
        *_edition(old, new),
        *frame_changes(old.frame, new.frame),
        *named,
        *command_changes(old, new, known),
        *family_changes(old, new),
        *prose.errata(old, new),
        *prose.vectors(old, new),
        *prose.evidence(old, new),
        *prose.history("changes", old.changes, new.changes),
    ]
    if old.name in new.bases or new.name in old.bases:
        # The changes of a delta repeat the other findings in words.
        found = [one for one in found if one.rule != "history-changed"]
    return _sorted(replace(one, where=f"{new.name}/{one.where}") for one in dict.fromkeys(found))


def diff_all(old: Mapping[str, Edition], new: Mapping[str, Edition]) -> tuple[Finding, ...]:
    """Compare editions of the same name; report added and removed editions."""
    found = [finding("edition-removed", name, name) for name in old if name not in new]
    found += [finding("edition-added", name, "", name) for name in new if name not in old]
    for name in old:
        if name in new:
            found.extend(diff(old[name], new[name]))
    return _sorted(iter(found))


def _sorted(found: Iterator[Finding]) -> tuple[Finding, ...]:
    # The sort is stable: findings of one level keep the order of the model.
    return tuple(sorted(found, key=lambda one: _SEVERITY[one.level]))


def _edition(old: Edition, new: Edition) -> Iterator[Finding]:
    """Compare the edition's own names and descriptions."""
    facts = (
        ("edition-renamed", "edition", old.name, new.name),
        ("class-renamed", "edition", old.class_name, new.class_name),
        ("firmware-changed", "edition", old.firmware, new.firmware),
        ("base-changed", "edition", *_bases(old, new)),
        ("joints-changed", "edition", old.joints, new.joints),
    )
    for rule, where, before, after in facts:
        if before != after:
            yield finding(rule, where, before, after)
    yield from robot_changes(old.robot, new.robot)
    yield from _state_changes(old, new)
    yield from prose.doc("edition/title", old.title, new.title)
    yield from prose.doc("edition", old.doc, new.doc)
    yield from prose.doc("edition/document", old.document, new.document)


def _bases(old: Edition, new: Edition) -> tuple[str, str]:
    """Return the base of each edition; if these are equal, each edition's whole chain of bases."""
    if old.base != new.base:
        return old.base, new.base
    return ", ".join(old.bases), ", ".join(new.bases)


def _state_changes(old: Edition, new: Edition) -> Iterator[Finding]:
    """Compare the state of arms that two editions declare."""
    before, after = ({state.name: state for state in side.states} for side in (old, new))
    for name in dict.fromkeys((*before, *after)):
        shown = [
            words.state(side[name]) if name in side else "not declared" for side in (before, after)
        ]
        if shown[0] != shown[1]:
            # If an old command acts on a new state, its effect has changed, which is another
            # finding.
            rule = "state-changed" if name in before else "state-added"
            yield finding(rule, f"edition/state/{name}", *shown)
