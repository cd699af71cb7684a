"""Compares commands: added, removed, renamed and changed ones."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cobotwire_codegen.diff import prose, words
from cobotwire_codegen.diff.api import result_changes, signature_changes
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.match import Matched, match
from cobotwire_codegen.diff.texts import text_changes
from cobotwire_codegen.diff.types import Known, wire_shape
from cobotwire_codegen.diff.variants import message_changes
from cobotwire_codegen.model import Command, Edition


def matched_commands(old: Edition, new: Edition) -> Matched[Command]:
    """Match commands by name, the remaining ones by id and variants."""
    return match(old.commands, new.commands, lambda command: command.name).further(_message)


def _message(command: Command) -> tuple[Any, ...]:
    """Return the properties of a command that are visible on the wire."""
    variants = tuple(
        tuple(
            tuple(word for field in variant for word in wire_shape(field.type))
            for variant in variants
        )
        for variants in (command.requests, command.replies)
    )
    return command.id, variants, words.template(command.text), words.template(command.request_text)


def command_changes(old: Edition, new: Edition, known: Known) -> Iterator[Finding]:
    """Compare all commands."""
    matched = matched_commands(old, new)
    for command in matched.removed:
        same = [other.name for other in new.commands if _message(other) == _message(command)]
        rule = "alias-removed" if same else "command-removed"
        yield finding(rule, f"commands/{command.name}", command.name, same[0] if same else "")
    for command in matched.added:
        yield finding("command-added", f"commands/{command.name}", "", command.name)
    # A command without its own deadline has the transport's; frame_changes reports that change.
    transports = old.frame.deadline_ms, new.frame.deadline_ms
    for before, after in matched.pairs:
        if before == after:
            continue
        where = f"commands/{after.name}"
        if before.name != after.name:
            yield finding("command-renamed", where, before.name, after.name)
        deadlines = before.deadline_ms, after.deadline_ms
        if before.deadline_ms != after.deadline_ms and deadlines != transports:
            yield finding("deadline-changed", where, *deadlines)
        yield from _command(where, before, after)
        yield from _messages(where, before, after, known)
    yield from _shared_ids(matched)


def _command(where: str, old: Command, new: Command) -> Iterator[Finding]:
    """Compare everything except the messages."""
    if old.id != new.id:
        yield finding("id-changed", where, f"{old.id:#04x}", f"{new.id:#04x}")
    if old.safety != new.safety:
        yield finding("safety-changed", where, old.safety, new.safety)
    if old.role != new.role:
        yield finding("role-changed", where, old.role or "none", new.role or "none")
    if words.effect(old.effect) != words.effect(new.effect):
        yield finding("effect-changed", where, words.effect(old.effect), words.effect(new.effect))
    if old.agrees_with != new.agrees_with:
        shown = [words.names(side.agrees_with) or "nothing" for side in (old, new)]
        yield finding("agreement-changed", where, *shown)
    if old.samples != new.samples:
        yield finding("samples-changed", where, words.samples(old), words.samples(new))
    if old.ack != new.ack:
        yield finding("ack-changed", where, words.yes(old.ack), words.yes(new.ack))
    if old.event != new.event:
        yield finding("event-changed", where, words.yes(old.event), words.yes(new.event))
    if old.accepted != new.accepted:
        shown = [_success(side) for side in (old, new)]
        yield finding("accepted-changed", where, *shown)
    if old.alias != new.alias:
        shown = [side.alias or "none" for side in (old, new)]
        yield finding("alias-changed", where, *shown)
    if old.shares_id != new.shares_id:
        shown = [", ".join(side.shares_id) or "none" for side in (old, new)]
        yield finding("sharing-changed", where, *shown)
    yield from prose.doc(f"{where}/title", old.title, new.title)
    yield from prose.doc(where, old.doc, new.doc)
    yield from prose.source(where, old.source, new.source)
    yield from prose.notes(where, old.notes, new.notes)
    if old.firmware != new.firmware:
        yield finding("versions-changed", where, *map(words.firmware, (old.firmware, new.firmware)))
    yield from prose.disputes(where, old.disputed, new.disputed)
    yield from prose.history(where, old.changes, new.changes)


def _success(command: Command) -> str:
    numbers = ", ".join(map(str, command.accepted))
    return f"the status {numbers}" if numbers else "any status except 0"


def _messages(where: str, old: Command, new: Command, known: Known) -> Iterator[Finding]:
    if old.event != new.event:
        # An event has neither method nor request; event-changed already reports that.
        yield from message_changes(f"{where}/reply", old, new, "reply", known)
        return
    found = list(message_changes(f"{where}/request", old, new, "request", known))
    yield from found
    # Report each difference once, by the more severe or more exact rule.
    moved = any(one.rule == "request-variant-changed" for one in found)
    kinds = {one.where for one in found if one.rule == "type-kind-changed"}
    for one in signature_changes(where, old, new, known):
        reported = (one.rule == "argument-order-changed" and moved) or (
            one.rule == "argument-type-changed" and one.where in kinds
        )
        if not reported:
            yield one
    yield from message_changes(f"{where}/reply", old, new, "reply", known)
    yield from result_changes(where, old, new, known)
    yield from text_changes(f"{where}/reply_text", "result", old.text, new.text)
    texts = old.request_text, new.request_text
    yield from text_changes(f"{where}/request_text", "argument", *texts)


def _shared_ids(matched: Matched[Command]) -> Iterator[Finding]:
    """Report a changed order of commands that share an id: the first one names the frames."""
    stayed = [j for _, j in matched.places]
    for id in dict.fromkeys(command.id for _, command in matched.pairs):
        before = [j for j in stayed if matched.new[j].id == id]
        if before != sorted(before):
            shown = [[matched.new[j].name for j in side] for side in (before, sorted(before))]
            yield finding("shared-id-order-changed", f"ids/{id:#04x}", *map(words.names, shown))
