"""Every query, with every argument that is worth a try."""

from __future__ import annotations

from cobotwire.conformance.device.catalogue import ANSWERED, ECHO, FIELDS, FRAME, ONCE, REPEATS
from cobotwire.conformance.device.hearing import Hearing, Reply, shown
from cobotwire.conformance.device.trial import Case, trial
from cobotwire.conformance.device.values import requests
from cobotwire.session.request import in_words
from cobotwire.table import Command, Field, Table

# Between two askings a value with a unit may move by so much of what the wire can say.
DRIFT = 0.02


def is_query(table: Table, command: Command) -> bool:
    """Whether a command only asks."""
    return command.safety == "query" and command.answers


@trial(ANSWERED, FRAME, FIELDS, ECHO, ONCE, REPEATS, of=is_query)
def query(case: Case) -> None:
    """Ask with each set of arguments, and the last one again."""
    known = case.bench.known()
    asked = [values for form in case.command.request for values in requests(form, known)]
    for values in asked:
        first = case.bench.ask(case.command, values)
        judge(case, first)
    again = case.bench.ask(case.command, asked[-1])
    judge(case, again)
    if first.good is not None and again.good is not None:
        repeats(case, first.good, again.good)
    if case.command.name in case.bench.retried:
        case.note(ANSWERED, "It was answered, but only when it was asked again.")


def judge(case: Case, hearing: Hearing) -> None:
    """What one question shows."""
    call, command = in_words(hearing.request, case.bench.asker.codec), hearing.request.command
    for damaged in hearing.damaged:
        reason = f"{call}: {expected_frame(case.bench.table, command)}; came {shown(damaged.data)}"
        case.expect(FRAME, False, reason)
    for reply in hearing.replies:
        case.expect(FRAME, True, "")
        error = reply.error
        case.expect(FIELDS, error is None, f"{call}: expected legal values; {error}")
        case.expect(ECHO, hearing.fitting(reply) or error is not None, _echo(call, hearing, reply))
    strays = hearing.strays
    once = len(hearing.replies) <= 1 and (not strays or not hearing.replies)
    case.expect(ONCE, once, f"{call}: expected one reply and no more; came {hearing.came}")
    in_time = bool(hearing.replies) and hearing.replies[0].seconds <= command.deadline_ms / 1000
    case.expect(ANSWERED, in_time, _late(call, hearing))


def expected_frame(table: Table, command: Command) -> str:
    """In words: the frame of a command's reply."""
    lengths = " or ".join(f"{table.frame.length(form.size):02X}" for form in command.reply)
    return f"expected a whole frame with id {command.id:02X} and LEN {lengths}"


def _echo(call: str, hearing: Hearing, reply: Reply) -> str:
    asked = {name: hearing.request.asked.get(name) for name in reply.fields}
    asked = {name: value for name, value in asked.items() if value is not None}
    return f"{call}: expected the echo of {asked}; came {reply.fields}"


def _late(call: str, hearing: Hearing) -> str:
    deadline = hearing.request.command.deadline_ms
    if hearing.replies:
        came = f"the reply came after {1000 * hearing.replies[0].seconds:.0f} ms"
    else:
        came = f"came {hearing.came}"
    return f"{call}: expected a reply within {deadline} ms; {came}"


def repeats(case: Case, first: Reply, again: Reply) -> None:
    """Two answers to the same question, one right after the other."""
    same = first.fields.keys() == again.fields.keys()
    case.expect(
        REPEATS, same, f"expected the same form of reply; came {first.fields}, {again.fields}"
    )
    if first.message is None or again.message is None:
        case.expect(REPEATS, first.fields == again.fields, f"came {first.fields}, {again.fields}")
        return
    for field in again.message.layout.fields:
        if field.name not in first.fields:
            continue
        before, after = first.fields[field.name], again.fields[field.name]
        reason = f"{field.name}: expected the same again; came {before}, then {after}"
        case.expect(REPEATS, _alike(field, before, after), reason)


def _alike(field: Field, before: object, after: object) -> bool:
    """The same; what has a unit is measured, and may have moved a little."""
    if before == after:
        return True
    rows = zip(
        field.cases[0].numbers,
        before if isinstance(before, tuple) else (before,),
        after if isinstance(after, tuple) else (after,),
    )
    for number, one, other in rows:
        span = (number.maximum - number.minimum) * number.multiply / number.divide
        if one != other and not (number.unit and abs(one - other) <= DRIFT * span):
            return False
    return True
