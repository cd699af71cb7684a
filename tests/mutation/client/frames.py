"""Requests in wrong frames, at wrong times, or sent too often."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

from cobotwire.conformance.codec.questions.malformed import damages
from cobotwire.protocol.table import Command
from mutation.client.sessions import PAUSE, ClientMutant, Sent, Session

# Commands of the class motion that a client may send at any time: they start no motion.
NO_MOTION = ("stop", "pause", "resume", "clear_queue", "jog_stop")
NO_MOTION_ROLES = ("stop", "halt")


def wrong_frames(session: Session) -> Iterator[ClientMutant]:
    """Yield requests with a wrong header, LEN, id or footer, or with a wrong size."""
    whole, table = session.frame, session.table
    at = table.frame.overhead
    taken = {command.id for command in table.commands}
    free = next(id for id in range(256) if id not in taken)
    others = (("id-unknown", free), ("id-of-another", session.other.id))
    wrong = [(name, whole[:at] + bytes([id]) + whole[at + 1 :]) for name, id in others]
    # Two kinds of damage to a check that give the same bytes have the same name.
    for name, data in dict((*damages(table, whole), *wrong)).items():
        if name == "twice" and session.command.safety == "query":
            continue  # a query may be repeated; a copy sent too soon is a mutant below
        kind = name.rstrip("0123456789ABCDEF+-").rstrip("-") or name
        yield session.mutant(kind, name, data + session.text)
    yield session.mutant("left-out", "left-out")


def wrong_times(session: Session) -> Iterator[ClientMutant]:
    """Yield requests that are resent, written into another frame, or sent too soon."""
    whole, query = session.whole, session.query
    first = (Sent(PAUSE, query), Sent(PAUSE, whole))
    if session.command.safety != "query":
        for after in (0.0, 0.05, 0.5, PAUSE):
            again = (*first, Sent(after, whole), Sent(PAUSE, query))
            yield session.timed("resent", f"after {after:g} s", *again)
    elif session.command.requires_reply:
        again = (*first, Sent(0.002, whole), Sent(PAUSE, query))
        yield session.timed("repeated too soon", "again after 2 ms", *again)
    if session.command.requires_reply:
        early = (*first, Sent(0.002, query))
        yield session.timed("reply not awaited", "another query after 2 ms", *early)
    for cut in range(1, len(session.frame)):
        pieces = session.frame[:cut] + query + session.frame[cut:] + session.text
        yield session.timed("interleaved", f"at {cut}", Sent(PAUSE, query), Sent(PAUSE, pieces))
    if session.text:
        yield session.mutant("text", "left out", session.frame)


def wrong_turns(sessions: list[Session]) -> Iterator[ClientMutant]:
    """Yield requests in the wrong order, after a power-off, or before a late reply."""
    for first, second in pairwise(sessions):
        if first.frame != second.frame:
            script = (first.line, second.line)
            writes = (Sent(PAUSE, second.whole), Sent(PAUSE, first.whole))
            yield ClientMutant("swapped", f"{first.place} and {second.place}", script, writes)
    for session in sessions:
        if session.command.requires_reply and not _echoes(session.command):
            yield from _before_late_reply(session, sessions)
    moves = [session for session in sessions if _starts_motion(session.command)]
    yield from _after("power_off", "unpowered", sessions, moves)
    joints = [session for session in moves if "gripper" not in session.command.name]
    yield from _after("release_all_servos", "released", sessions, joints)


def _before_late_reply(session: Session, sessions: list[Session]) -> Iterator[ClientMutant]:
    alike = (s for s in sessions if s.command.id == session.command.id and s.command.requires_reply)
    other = next((s for s in alike if s.frame != session.frame), None)
    if other is not None:
        writes = (Sent(PAUSE, session.frame), Sent(0.5, other.frame))
        text = f"{session.place}, then {other.place}"
        yield ClientMutant("late reply", text, (session.line, other.line), writes, lost=True)


def _echoes(command: Command) -> bool:
    return all(any(field.echo for field in variant.fields) for variant in command.reply)


def _starts_motion(command: Command) -> bool:
    stops = command.name in NO_MOTION or command.role in NO_MOTION_ROLES
    return command.safety == "motion" and not stops


def _after(
    name: str, kind: str, sessions: list[Session], moves: Iterable[Session]
) -> Iterator[ClientMutant]:
    """Yield motions after the command that switches the power off or releases the joints."""
    off = next((session for session in sessions if session.command.name == name), None)
    for session in moves if off else ():
        assert off is not None
        writes = (Sent(PAUSE, off.frame), Sent(PAUSE, session.whole))
        yield ClientMutant(kind, session.place, (off.line, session.line), writes)
