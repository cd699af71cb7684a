"""Rules for questions: one at a time, and not again before the reply can have come."""

from __future__ import annotations

from cobotwire.conformance.client.past import Heard, Past
from cobotwire.conformance.client.rules.rule import Judgement, rule

NOTES = "field notes: a reply comes within about 30 ms or never"
# The latest reply that was ever seen.
OWED_SECONDS = 0.727


@rule("reply-awaited", "no question before the reply to the one before it", NOTES)
def reply_awaited(past: Past, now: Heard) -> Judgement:
    """Frames carry no numbers: of two questions at once, nobody knows whose the reply is.

    An order may go out while a question waits: a stop must.
    """
    if not now.is_question:
        return None
    for other in past.unanswered(now.at - past.patience):
        if other.data != now.data and other.command is not None:
            after = (now.at - other.at) * 1000
            return f"asked {after:.1f} ms after {other.command.name}, which was not answered yet"
    return ""


@rule("reply-given-time", "a question is not asked again before a reply can have come", NOTES)
def reply_given_time(past: Past, now: Heard) -> Judgement:
    """The same question again, too soon: its reply is taken for that to the second one."""
    if not now.is_question:
        return None
    for other in past.unanswered(now.at - past.patience):
        if other.data == now.data:
            return f"asked again after {(now.at - other.at) * 1000:.1f} ms"
    return ""


@rule(
    "late-reply-expected",
    "while a reply is owed, nothing is asked that it could be taken to answer",
    "field notes: a reply was seen 727 ms after its request",
)
def late_reply_expected(past: Past, now: Heard) -> Judgement:
    """Another question with the same id, whose replies have no echo that tells them apart."""
    if not now.is_question or now.command is None:
        return None
    for other in past.unanswered(now.at - OWED_SECONDS):
        if other.command is None or other.data == now.data or _told_apart(other, now):
            continue
        if now.at - other.at < past.patience:
            continue  # reply_awaited's
        after = (now.at - other.at) * 1000
        return (
            f"asked {after:.0f} ms after {other.data.hex(' ').upper()}, whose reply is still "
            "owed and would look the same"
        )
    return ""


def _told_apart(other: Heard, now: Heard) -> bool:
    if other.command is None or now.command is None or other.command.id != now.command.id:
        return True
    # A reply without its echo is another form; where one form lacks it, nothing tells.
    return bool(now.command.reply) and all(
        any(field.echo for field in form.fields) for form in now.command.reply
    )
