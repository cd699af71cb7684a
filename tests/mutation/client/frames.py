"""Requests in wrong frames, at wrong times, or sent too often."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from cobotwire.conformance.client import ScriptLine
from cobotwire.conformance.codec.questions.malformed import damages
from cobotwire.protocol.table import Command, Table
from mutation.client.mutant import PAUSE, ClientMutant, Sent
from mutation.client.sessions import Session

# Of the class motion, but a client may send them at any time: they start no motion.
NO_MOTION = ("stop", "pause", "resume", "clear_queue", "jog_stop")
NO_MOTION_ROLES = ("stop", "halt")


def wrong_frames(session: Session) -> Iterator[ClientMutant]:
    """Yield requests with a wrong header, LEN, id or footer, or with a wrong size."""
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
        writes = session.writes(data + session.text) if data else session.writes()
        if name == "twice" and session.command.safety == "query":
            continue  # a query may be repeated; a copy sent too soon is a mutant below
        yield ClientMutant(kind, f"{kind}: {session.place}: {name}", session.script(), writes)


def wrong_times(session: Session) -> Iterator[ClientMutant]:
    """Yield requests that are resent, written into another frame, or sent too soon."""
    whole = session.frame + session.text
    query = session.command.safety == "query"
    place = session.place
    if not query:
        for after in (0.0, 0.05, 0.5, PAUSE):
            again = (*session.writes(whole)[:2], Sent(after, whole), Sent(PAUSE, session.query))
            name = f"resent: {place}: after {after:g} s"
            yield ClientMutant("resent", name, session.script(), again)
    elif session.command.requires_reply:
        again = (*session.writes(whole)[:2], Sent(0.002, whole), Sent(PAUSE, session.query))
        name = f"repeated too soon: {place}: again after 2 ms"
        yield ClientMutant("repeated too soon", name, session.script(), again)
    if session.command.requires_reply:
        early = (*session.writes(whole)[:2], Sent(0.002, session.query))
        name = f"reply not awaited: {place}: another query after 2 ms"
        yield ClientMutant("reply not awaited", name, session.script(), early)
    for cut in range(1, len(session.frame)):
        pieces = session.frame[:cut] + session.query + session.frame[cut:] + session.text
        name = f"interleaved: {place}: at {cut}"
        writes = (Sent(PAUSE, session.query), Sent(PAUSE, pieces))
        yield ClientMutant("interleaved", name, session.script(), writes)
    if session.text:
        name = f"text: {place}: left out"
        yield ClientMutant("text", name, session.script(), session.writes(session.frame))


def wrong_turns(table: Table, sessions: list[Session]) -> Iterator[ClientMutant]:
    """Yield requests in the wrong order, after a power-off, or before a late reply."""
    for first, second in pairwise(sessions):
        if first.frame == second.frame:
            continue
        script = (first.script()[1], second.script()[1])
        frames = (second.frame + second.text, first.frame + first.text)
        name = f"swapped: {first.place} and {second.place}"
        writes = tuple(Sent(PAUSE, data) for data in frames)
        yield ClientMutant("swapped", name, script, writes)
    yield from _before_late_replies(sessions)
    yield from _unpowered(table, sessions)


def _before_late_replies(sessions: list[Session]) -> Iterator[ClientMutant]:
    for session in sessions:
        if not session.command.requires_reply or _echoes(session.command):
            continue
        like = [
            s for s in sessions if s.command.id == session.command.id and s.command.requires_reply
        ]
        other = next((s for s in like if s.frame != session.frame), None)
        if other is not None:
            script = (session.script()[1], other.script()[1])
            writes = (Sent(PAUSE, session.frame), Sent(0.5, other.frame))
            name = f"late reply: {session.place}, then {other.place}"
            yield ClientMutant("late reply", name, script, writes, lost=True)


def _echoes(command: Command) -> bool:
    return all(any(field.echo for field in variant.fields) for variant in command.reply)


def _unpowered(table: Table, sessions: list[Session]) -> Iterator[ClientMutant]:
    """Yield motions after a power-off, and motions of joints after all joints were released."""
    moves = [
        s
        for s in sessions
        if s.command.safety == "motion"
        and s.command.name not in NO_MOTION
        and s.command.role not in NO_MOTION_ROLES
    ]
    joints = [session for session in moves if "gripper" not in session.command.name]
    for kind, name, after in (
        ("unpowered", "power_off", moves),
        ("released", "release_all_servos", joints),
    ):
        off = next((session for session in sessions if session.command.name == name), None)
        for session in after if off else ():
            assert off is not None
            script: tuple[ScriptLine, ...] = (off.script()[1], session.script()[1])
            writes = (Sent(PAUSE, off.frame), Sent(PAUSE, session.frame + session.text))
            yield ClientMutant(kind, f"{kind}: {session.place}", script, writes)
