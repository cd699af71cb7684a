"""What is no legal request: it is ignored or refused, and the next good one is answered.

Only queries are spoilt: what a firmware might obey all the same changes nothing.
"""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.conformance.device.catalogue import (
    CUT,
    NOISE_BEFORE,
    OUT_OF_RANGE,
    PIECES,
    RECOVERS,
    TOGETHER,
    UNKNOWN_ID,
    WRONG_FOOTER,
    WRONG_LENGTH,
    Rule,
)
from cobotwire.conformance.device.hearing import Hearing
from cobotwire.conformance.device.trial import Case, trial
from cobotwire.conformance.device.trials.queries import is_query
from cobotwire.conformance.device.values import requests
from cobotwire.session.request import Request
from cobotwire.table import Command, FrameFormat, Table

# A packet of the servo bus, a header that leads nowhere, text, and half a frame.
NOISES = ("ff ff 01 04 02 38 02 be", "fe fe", "63 6d 64 0d 0a", "fe fe fe 30")


def is_framed_query(table: Table, command: Command) -> bool:
    """Whether a command only asks, and is answered by a frame."""
    return is_query(table, command) and bool(command.reply)


@trial(WRONG_LENGTH, WRONG_FOOTER, CUT, RECOVERS, of=is_framed_query, leave=("malformed",))
def damaged(case: Case) -> None:
    """Requests with a wrong LEN or footer, and such as break off."""
    request = sample(case)
    for rule, what, data in spoilt(case.bench.table.frame, request.frame):
        unanswered(case, rule, request, what, data)
        recovers(case, request, what)


def sample(case: Case) -> Request:
    """The request that is spoilt: the first that is worth a try."""
    values = requests(case.command.request[0], case.bench.known())[0]
    return case.bench.asker.request(case.command, values)


def spoilt(frame: FrameFormat, data: bytes) -> Iterator[tuple[Rule, str, bytes]]:
    """A legal request, damaged in each way: the rule that it breaks, what it is, its bytes."""
    at = frame.length_at
    longer = data[:at] + bytes([data[at] + 1]) + data[at + 1 :]
    yield WRONG_LENGTH, "LEN one too large", longer
    yield WRONG_LENGTH, "LEN one too small", data[:at] + bytes([data[at] - 1]) + data[at + 1 :]
    end = len(data) - frame.check_size
    more = longer[:end] + b"\x00" + longer[end:]
    if frame.check == "footer":
        yield WRONG_LENGTH, "a data byte too many, and LEN with it", more
    yield WRONG_FOOTER, "wrong footer", data[:-1] + bytes([data[-1] ^ 0xFF])
    yield CUT, "broken off before the footer", data[:-1]
    yield CUT, "broken off behind LEN", data[: at + 1]


def unanswered(case: Case, rule: Rule, request: Request, what: str, data: bytes) -> None:
    """Send what is no request; the firmware may complain in words, but not answer."""
    bench = case.bench
    at = bench.table.frame.length_at
    half = data[at] + at + 1 > len(data)
    wait = bench.waits.idle if half else bench.waits.silence
    hearing = bench.note(bench.asker.told(request, data, what, wait))
    silent = not hearing.replies and not hearing.strays
    case.expect(rule, silent, f"{what}: expected no answer; came {hearing.came}")


def recovers(case: Case, request: Request, what: str) -> None:
    """The next good request is answered."""
    bench = case.bench
    hearing = bench.note(bench.asker.ask(request))
    _answered_once(case, RECOVERS, hearing, f"the good request after {what}")


def _answered_once(case: Case, rule: Rule, hearing: Hearing, what: str) -> None:
    once = hearing.good is not None and len(hearing.replies) == 1 and not hearing.strays
    case.expect(rule, once, f"{what}: expected one legal reply; came {hearing.came}")


def can_be_forbidden(table: Table, command: Command) -> bool:
    """Whether bytes can say arguments that the edition does not allow."""
    fields = command.request[0].fields
    return is_framed_query(table, command) and any(
        _forbidden(field.choices, number.minimum, number.maximum, number.width)
        for field in fields
        for number in field.cases[0].numbers
    )


@trial(OUT_OF_RANGE, RECOVERS, of=can_be_forbidden, leave=("malformed",))
def forbidden(case: Case) -> None:
    """Arguments that the edition does not allow."""
    request = sample(case)
    for what, data in out_of_range(case.bench.table, case.command, request.frame):
        unanswered(case, OUT_OF_RANGE, request, what, data)
        recovers(case, request, what)


def out_of_range(table: Table, command: Command, data: bytes) -> Iterator[tuple[str, bytes]]:
    """A legal request with a number outside each field's range or list, as far as bytes can say."""
    if table.frame.check != "footer":
        return
    at = table.frame.length_at + 2
    for field in command.request[0].fields:
        for number in field.cases[0].numbers:
            for word in _forbidden(field.choices, number.minimum, number.maximum, number.width):
                said = word.to_bytes(number.width, number.order)
                name = f"{field.name}.{number.name}" if number.name else field.name
                yield f"{name} = {word}", data[:at] + said + data[at + number.width :]
            at += number.width


def _forbidden(choices: tuple[int, ...], low: int, high: int, width: int) -> list[int]:
    """Words that stand for no allowed number, whatever the sign rule."""
    if low < 0:
        return []
    allowed = set(choices) or range(low, high + 1)
    near = {low - 1, high + 1, 256**width - 1, *(choice + 1 for choice in choices)}
    return sorted(word for word in near if 0 <= word < 256**width and word not in allowed)


@trial(NOISE_BEFORE, TOGETHER, PIECES, of=is_framed_query, leave=("malformed",))
def crowded(case: Case) -> None:
    """Legal requests behind noise, two at once, and in pieces."""
    bench, request = case.bench, sample(case)
    for noise in NOISES:
        sent = bytes.fromhex(noise) + request.frame
        hearing = bench.note(bench.asker.exchange(request, sent, "noise and a request"))
        _answered_once(case, NOISE_BEFORE, hearing, f"the request behind {noise.upper()}")
    pieces(case, request)
    together(case, request)


def pieces(case: Case, request: Request) -> None:
    """One byte at a time."""
    bench, frame = case.bench, request.frame
    for at in range(len(frame) - 1):
        hearing = bench.asker.told(request, frame[at : at + 1], "a piece", bench.waits.pause)
        case.expect(PIECES, not hearing.replies, f"half a request: came {hearing.came}")
    hearing = bench.note(bench.asker.exchange(request, frame[-1:], "the last piece"))
    _answered_once(case, PIECES, hearing, "the request in pieces")


def together(case: Case, request: Request) -> None:
    """Two requests in one write, and three."""
    bench = case.bench
    for count in (2, 3):
        frames = request.frame * count
        hearing = bench.note(bench.asker.exchange(request, frames, f"{count} requests"))
        if len(hearing.replies) < count:
            bench.asker.quiet(hearing, bench.line.now, request.command.deadline_ms / 1000)
        legal = [reply for reply in hearing.replies if hearing.fitting(reply)]
        all_of_them = len(legal) == len(hearing.replies) == count and not hearing.strays
        reason = f"{count} requests: expected {count} replies; came {hearing.came}"
        case.expect(TOGETHER, all_of_them, reason)


@trial(UNKNOWN_ID, RECOVERS, of=None, leave=("malformed",))
def unknown(case: Case) -> None:
    """Ids that the edition lacks, without data and with some."""
    table = case.bench.table
    carrier = next(
        c for c in table.commands if is_framed_query(table, c) and not c.request[0].fields
    )
    request = case.bench.asker.request(carrier, ())
    if table.frame.check != "footer":
        return
    for id in unknown_ids(table):
        for data in (b"", b"\x01"):
            length = bytes([table.frame.length(len(data))])
            address = bytes(table.frame.addresses[:1])
            sent = table.frame.header + address + length + bytes([id]) + data + table.frame.footer
            unanswered(case, UNKNOWN_ID, request, f"the unknown id {id:02X}", sent)
    recovers(case, request, "unknown ids")


def unknown_ids(table: Table) -> list[int]:
    """Some ids that no command has: the ends, and spread between."""
    known = {command.id for command in table.commands}
    free = [id for id in range(256) if id not in known]
    return free[:1] + free[1:-1:24] + free[-1:]
