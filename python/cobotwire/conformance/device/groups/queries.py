"""Every query, with every set of arguments that may reveal a mistake."""

from __future__ import annotations

from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.response import Reply, Response, shown
from cobotwire.conformance.device.samples import arguments
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.table import Command, Field, Table

# Between two requests a value with a unit may move by this share of its range.
DRIFT = 0.02


def _echoes(command: Command) -> bool:
    return any(field.echo for variant in command.reply for field in variant.fields)


def _is_framed(command: Command) -> bool:
    return bool(command.reply)


REPLIED = TestCase("query-replied", "A query is replied to within its deadline.")
FRAME = TestCase(
    "reply-frame",
    "A reply is a whole frame: header, LEN, id, footer as the edition defines them.",
    applies=_is_framed,
)
FIELDS = TestCase("reply-fields", "Each field of a reply holds a value that the edition allows.")
ECHO = TestCase(
    "reply-echo", "A reply repeats the arguments that the edition says it repeats.", applies=_echoes
)
ONCE = TestCase("reply-once", "A query is replied to once, and nothing follows the reply.")
REPEATS = TestCase(
    "reply-repeats", "A query that is repeated while nothing changes has the same reply."
)


def is_query(table: Table, command: Command) -> bool:
    """Return whether a command only reads."""
    return command.safety == "query" and command.answers


def _query(probe: Probe) -> None:
    """Request with each set of arguments, and with the last one again."""
    known = probe.device.known()
    every = [values for variant in probe.command.request for values in arguments(variant, known)]
    for values in every:
        first = probe.device.request(probe.command, values)
        _judge(probe, first)
    again = probe.device.request(probe.command, every[-1])
    _judge(probe, again)
    if first.valid is not None and again.valid is not None:
        _judge_repetition(probe, first.valid, again.valid)
    if probe.command.name in probe.device.retried:
        probe.note(REPLIED, "A reply came, but only when the query was repeated.")


def _judge(probe: Probe, response: Response) -> None:
    command = response.request.command
    call = probe.device.requester.describe(response.request)
    for damaged in response.damaged:
        expected = _expected_frame(probe.device.table, command)
        probe.expect(FRAME, False, f"{call}: {expected}; came {shown(damaged.data)}")
    for reply in response.replies:
        probe.expect(FRAME, True, "")
        error = reply.error
        probe.expect(FIELDS, error is None, f"{call}: expected legal values; {error}")
        echoed = response.accepts(reply) or error is not None
        probe.expect(ECHO, echoed, _wrong_echo(call, response, reply))
    once = not response.replies or (len(response.replies) == 1 and not response.unexpected)
    probe.expect(ONCE, once, f"{call}: expected one reply and no more; came {response.summary}")
    deadline = command.deadline_ms
    in_time = bool(response.replies) and response.replies[0].seconds <= deadline / 1000
    probe.expect(REPLIED, in_time, _late(call, response, deadline))


def _expected_frame(table: Table, command: Command) -> str:
    lengths = " or ".join(f"{table.frame.length(variant.size):02X}" for variant in command.reply)
    return f"expected a whole frame with id {command.id:02X} and LEN {lengths}"


def _wrong_echo(call: str, response: Response, reply: Reply) -> str:
    sent = {name: response.request.arguments.get(name) for name in reply.fields}
    sent = {name: value for name, value in sent.items() if value is not None}
    return f"{call}: expected the echo of {sent}; came {reply.fields}"


def _late(call: str, response: Response, deadline: int) -> str:
    came = f"came {response.summary}"
    if response.replies:
        came = f"the reply came after {1000 * response.replies[0].seconds:.0f} ms"
    return f"{call}: expected a reply within {deadline} ms; {came}"


def _judge_repetition(probe: Probe, first: Reply, again: Reply) -> None:
    """Compare the replies to two equal requests, one right after the other."""
    both = f"came {first.fields}, then {again.fields}"
    same_variant = first.fields.keys() == again.fields.keys()
    probe.expect(REPEATS, same_variant, f"expected the same variant of reply; {both}")
    if first.message is None or again.message is None:
        probe.expect(REPEATS, first.fields == again.fields, both)
        return
    for field in again.message.variant.fields:
        if field.name not in first.fields:
            continue
        before, after = first.fields[field.name], again.fields[field.name]
        reason = f"{field.name}: expected the same again; came {before}, then {after}"
        probe.expect(REPEATS, _alike(field, before, after), reason)


def _alike(field: Field, before: object, after: object) -> bool:
    """Return whether two values are the same; a measured one, with a unit, may move a little."""
    if before == after:
        return True
    rows = zip(
        field.cases[0].numbers,
        before if isinstance(before, tuple) else (before,),
        after if isinstance(after, tuple) else (after,),
    )
    for number, one, other in rows:
        span = number.physical(number.maximum - number.minimum)
        if one != other and not (number.unit and abs(one - other) <= DRIFT * span):
            return False
    return True


QUERIES = Group("queries", (REPLIED, FRAME, FIELDS, ECHO, ONCE, REPEATS), _query, is_query)
