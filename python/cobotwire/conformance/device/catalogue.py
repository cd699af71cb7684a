"""Every rule: its id, and what it says. Ids are stable; the sentences may improve."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from cobotwire.table import Command


def _any(command: Command) -> bool:
    return True


def _echoes(command: Command) -> bool:
    return any(field.echo for form in command.reply for field in form.fields)


def _framed(command: Command) -> bool:
    return bool(command.reply)


def _silent(command: Command) -> bool:
    return not command.reply and command.text is None


def _acknowledged(command: Command) -> bool:
    return command.ack


def _answers(command: Command) -> bool:
    return command.answers


@dataclass(frozen=True, slots=True)
class Rule:
    """A law of the protocol that a test can find broken; ``of`` tells for which commands."""

    id: str
    says: str
    of: Callable[[Command], bool] = _any


ANSWERED = Rule("query-answered", "A query is answered within its deadline.")
FRAME = Rule(
    "reply-frame", "A reply is a whole frame: header, LEN, id, footer as the edition says.", _framed
)
FIELDS = Rule("reply-fields", "Each field of a reply holds a value that the edition allows.")
ECHO = Rule(
    "reply-echo", "A reply repeats the arguments that the edition says it repeats.", _echoes
)
ONCE = Rule("reply-once", "A query is answered once, and nothing stands behind the answer.")
REPEATS = Rule("reply-repeats", "A query that is asked again while nothing changes says the same.")
SILENT = Rule("order-silent", "A command without a reply is not answered.", _silent)
ACKNOWLEDGED = Rule(
    "order-acknowledged",
    "An acknowledgement comes once at most, is legal, and says 1: done.",
    _acknowledged,
)
ALIKE = Rule("acks-alike", "An arm that acknowledges commands acknowledges all that it may.")
REPLIED = Rule(
    "order-answered", "A command that has a reply is answered once, and legally.", _answers
)
READ_BACK = Rule("read-back", "What was set is what is read.")
NEIGHBOURS = Rule("neighbours-stay", "Setting one joint, pin or register leaves the others.")
RESTORED = Rule("restored", "What was there before a test can be set again, and is.")
AGREES = Rule("agrees", "While the arm rests, queries of the same thing tell the same.")
EFFECT = Rule("effect", "What a command switches is what the query of it tells.")
ARRIVES = Rule("arrives", "The arm goes where it was sent, and its other joints stay.")
REACHED = Rule("reached", "The arm says that it is where it was sent, and nowhere else.")
MOVING = Rule("moving", "The arm says that it moves while it does, and not when it stands.")
STOPS = Rule("stops", "A stop ends the motion, and the arm stands.")
WRONG_LENGTH = Rule("wrong-length", "A request with a wrong LEN is not answered.")
WRONG_FOOTER = Rule("wrong-footer", "A request with a wrong footer is not answered.")
CUT = Rule("cut-request", "A request that breaks off is given up when the line is silent.")
OUT_OF_RANGE = Rule("out-of-range", "A request with a value that is not allowed is not obeyed.")
UNKNOWN_ID = Rule("unknown-id", "A request with an id that the edition lacks is not answered.")
NOISE_BEFORE = Rule("noise-before", "A request behind noise is answered.")
TOGETHER = Rule("two-in-one-write", "Requests in one write are all answered, in their order.")
PIECES = Rule("request-in-pieces", "A request in pieces with pauses is answered as a whole one.")
RECOVERS = Rule("recovers", "After what is no legal request, the next good one is answered.")

RULES = tuple(value for value in globals().values() if isinstance(value, Rule))
