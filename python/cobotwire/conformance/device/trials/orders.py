"""What comes after a command that is no query: nothing, an acknowledgement, or its reply."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from cobotwire.conformance.device.catalogue import ACKNOWLEDGED, REPLIED, SILENT
from cobotwire.conformance.device.hearing import Hearing
from cobotwire.conformance.device.trial import Case
from cobotwire.session.request import in_words
from cobotwire.table import Command

# The firmware's word on a setter: done.
DONE = 1


def order(
    case: Case, command: Command, values: Sequence[Any], text: Mapping[str, str] | None = None
) -> Hearing:
    """Send an order, and judge what comes."""
    hearing = case.bench.ask(command, values, text)
    call = in_words(hearing.request, case.bench.asker.codec)
    if command.answers:
        _replied(case, hearing, call)
    elif command.ack:
        _acknowledged(case, hearing, call)
    else:
        silent = not hearing.replies and not hearing.strays
        case.expect(SILENT, silent, f"{call}: expected silence; came {hearing.came}")
    return hearing


def _replied(case: Case, hearing: Hearing, call: str) -> None:
    """One legal reply in time, and none behind it."""
    bench, deadline = case.bench, hearing.request.command.deadline_ms
    bench.asker.quiet(hearing, bench.line.now, bench.waits.silence)
    legal = len(hearing.replies) == 1 and hearing.good is not None and not hearing.strays
    case.expect(REPLIED, legal, f"{call}: expected one legal reply; came {hearing.came}")
    if hearing.replies:
        took = 1000 * hearing.replies[0].seconds
        reason = f"{call}: expected the reply within {deadline} ms; it took {took:.0f} ms"
        case.expect(REPLIED, took <= deadline, reason)


def _acknowledged(case: Case, hearing: Hearing, call: str) -> None:
    command = hearing.request.command
    case.bench.acknowledged.setdefault(command.name, bool(hearing.replies))
    legal = len(hearing.replies) <= 1 and not hearing.strays
    done = all(
        reply.error is None and all(value == DONE for value in reply.fields.values())
        for reply in hearing.replies
    )
    reason = f"{call}: expected one acknowledgement, 1, or none; came {hearing.came}"
    case.expect(ACKNOWLEDGED, legal and done, reason)
