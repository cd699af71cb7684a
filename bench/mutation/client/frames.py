"""Requests whose frame is wrong, and what is wrong about when and how often they are sent."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from cobotwire.conformance.client import Told
from cobotwire.conformance.codec.trials.malformed import damages
from cobotwire.table import Command, Table
from mutation.client.mutant import PAUSE, ClientMutant, Sent
from mutation.client.sessions import Session


def wrong_frames(session: Session) -> Iterator[ClientMutant]:
    """Header, LEN, id, footer, too short, too long."""
    whole = session.frame
    at = session.table.frame.overhead
    taken = {command.id for command in session.table.commands}
    free = next(id for id in range(256) if id not in taken)
    wrong = list(damages(session.table, whole))
    wrong.append(("id-unknown", whole[:at] + bytes([free]) + whole[at + 1 :]))
    other = session.other.id
    wrong.append(("id-of-another", whole[:at] + bytes([other]) + whole[at + 1 :]))
    wrong.append(("left-out", b""))
    for name, data in wrong:
        kind = name.rstrip("0123456789ABCDEF+-").rstrip("-") or name
        writes = session.writes(data + session.behind) if data else session.writes()
        if name == "twice" and session.command.safety == "query":
            continue  # a query may be sent twice; too soon is a mutant below
        yield ClientMutant(kind, f"{kind}: {session.place}: {name}", session.told(), writes)


def wrong_times(session: Session) -> Iterator[ClientMutant]:
    """Sent again, written into another frame, asked too soon, asked while a reply is owed."""
    whole = session.frame + session.behind
    query = session.command.safety == "query"
    place = session.place
    if not query:
        for after in (0.0, 0.05, 0.5, PAUSE):
            again = (*session.writes(whole)[:2], Sent(after, whole), Sent(PAUSE, session.question))
            name = f"resent: {place}: after {after:g} s"
            yield ClientMutant("resent", name, session.told(), again)
    elif session.command.answers:
        again = (*session.writes(whole)[:2], Sent(0.002, whole), Sent(PAUSE, session.question))
        name = f"asked too soon: {place}: again after 2 ms"
        yield ClientMutant("asked too soon", name, session.told(), again)
    if session.command.answers:
        early = (*session.writes(whole)[:2], Sent(0.002, session.question))
        name = f"reply not awaited: {place}: another question after 2 ms"
        yield ClientMutant("reply not awaited", name, session.told(), early)
    for cut in range(1, len(session.frame)):
        pieces = session.frame[:cut] + session.question + session.frame[cut:] + session.behind
        name = f"interleaved: {place}: at {cut}"
        writes = (Sent(PAUSE, session.question), Sent(PAUSE, pieces))
        yield ClientMutant("interleaved", name, session.told(), writes)
    if session.behind:
        name = f"text: {place}: left out"
        yield ClientMutant("text", name, session.told(), session.writes(session.frame))


def wrong_turns(table: Table, sessions: list[Session]) -> Iterator[ClientMutant]:
    """Two requests in the wrong order, a motion behind a power-off, a like question too early."""
    for first, second in pairwise(sessions):
        if first.frame == second.frame:
            continue
        told = (first.told()[1], second.told()[1])
        frames = (second.frame + second.behind, first.frame + first.behind)
        name = f"changed over: {first.place} and {second.place}"
        writes = tuple(Sent(PAUSE, data) for data in frames)
        yield ClientMutant("changed over", name, told, writes)
    yield from _into_debts(sessions)
    yield from _unpowered(table, sessions)


def _into_debts(sessions: list[Session]) -> Iterator[ClientMutant]:
    for session in sessions:
        if not session.command.answers or _echoes(session.command):
            continue
        like = [s for s in sessions if s.command.id == session.command.id and s.command.answers]
        other = next((s for s in like if s.frame != session.frame), None)
        if other is not None:
            told = (session.told()[1], other.told()[1])
            writes = (Sent(PAUSE, session.frame), Sent(0.5, other.frame))
            name = f"reply owed: {session.place}, then {other.place}"
            yield ClientMutant("reply owed", name, told, writes, lost=True)


def _echoes(command: Command) -> bool:
    return all(any(field.echo for field in form.fields) for form in command.reply)


def _unpowered(table: Table, sessions: list[Session]) -> Iterator[ClientMutant]:
    off = next((s for s in sessions if s.command.name == "power_off"), None)
    for session in sessions:
        if off is not None and session.command.safety == "motion":
            told: tuple[Told, ...] = (off.told()[1], session.told()[1])
            writes = (Sent(PAUSE, off.frame), Sent(PAUSE, session.frame + session.behind))
            yield ClientMutant("unpowered", f"unpowered: {session.place}", told, writes)
