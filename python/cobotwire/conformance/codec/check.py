"""Compare an answer with the right one, and yield an observation for each test case."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import Any

from cobotwire.conformance.codec.questions.frames import ENCODE_REJECTS, REJECTION_REASON
from cobotwire.conformance.codec.questions.question import Json, Question
from cobotwire.conformance.codec.questions.streams import (
    NOISE_REASON,
    STREAM_CHUNKS,
    STREAM_FRAMES,
    STREAM_NOISE,
)
from cobotwire.conformance.suite import TestCase
from cobotwire.conformance.tally import Observation
from cobotwire.protocol.table import Table

# Test cases that require an optional ability; the greeting says whether the codec has it.
ABILITIES: dict[TestCase, str] = {
    REJECTION_REASON: "reasons",
    NOISE_REASON: "reasons",
    STREAM_NOISE: "noise",
}


def check(
    table: Table, question: Question, answer: Json, can: Collection[str]
) -> Iterator[Observation]:
    """Yield an observation for each test case that the question tests."""
    expect = question.expect
    if "events" in expect:
        yield from _stream(expect["events"], answer, can)
    elif "error" in expect:
        yield from _rejection(question, answer, can)
    elif "bytes" in expect:
        yield Observation(question.case, _bytes(expect["bytes"], answer))
    else:
        yield Observation(question.case, _values(table, question, answer))


def _bytes(right: str, answer: Json) -> str:
    got = answer.get("bytes")
    if not isinstance(got, str):
        return f"expected {right}, but the answer was {_shown(answer)}"
    plain = _digits(got)
    return "" if plain == right else f"expected {right}, got {plain}"


def _digits(hexadecimal: str) -> str:
    return "".join(hexadecimal.split()).upper()


def _rejection(question: Question, answer: Json, can: Collection[str]) -> Iterator[Observation]:
    right, why = question.expect["error"], question.expect["why"]
    if "error" not in answer:
        yield Observation(
            question.case, f"expected a rejection ({why}), but the answer was {_shown(answer)}"
        )
        return
    yield Observation(question.case, "")
    if "reasons" not in can or question.case is ENCODE_REJECTS:
        return
    expected = (right, question.expect["offset"])
    got = (answer["error"], answer.get("offset"))
    wrong = f"expected {expected[0]} at byte {expected[1]}, got {got[0]} at byte {got[1]}"
    yield Observation(REJECTION_REASON, "" if got == expected else wrong)


def _values(table: Table, question: Question, answer: Json) -> str:
    right, got = question.expect, answer.get("fields")
    if not isinstance(got, dict):
        return f"expected {right['fields']}, but the answer was {_shown(answer)}"
    if answer.get("command") != right["command"]:
        return f"expected {right['command']}, decoded as {answer.get('command')}"
    # An echo only identifies the request; the codec may leave it out.
    needed = set(right["fields"]) - _echoes(table, right["command"])
    if not needed <= set(got) <= set(right["fields"]):
        return f"expected the fields {sorted(right['fields'])}, got {sorted(got)}"
    steps = _steps(table, right["command"], question.ask["direction"])
    for name in _octets(table, right["command"]) & set(got):
        if isinstance(got[name], str):
            got = got | {name: _digits(got[name])}
    for name, value in right["fields"].items():
        if name in got and not _alike(value, got[name], steps.get(name, 1.0)):
            return f"{name}: expected {value}, got {got[name]}"
    return ""


def _echoes(table: Table, name: str) -> set[str]:
    reply = table.command(name).reply
    return {field.name for variant in reply for field in variant.fields if field.echo}


def _octets(table: Table, name: str) -> set[str]:
    command = table.command(name)
    variants = (*command.request, *command.reply)
    return {field.name for each in variants for field in each.fields if field.kind == "bytes"}


def _steps(table: Table, name: str, direction: Any) -> dict[str, float]:
    """Return the finest step of each field, because a codec may round differently from Python."""
    return {
        field.name: min((number.physical(1) for number in field.numbers), default=1.0)
        for variant in table.command(name).variants(direction)
        for field in variant.fields
    }


def _alike(right: Any, got: Any, step: float) -> bool:
    if isinstance(right, list):
        return (
            isinstance(got, list)
            and len(right) == len(got)
            and all(_alike(a, b, step) for a, b in zip(right, got))
        )
    if isinstance(right, str):
        # Text, bytes, or a number that is not finite.
        return isinstance(got, str) and right == got
    try:
        return isinstance(got, int | float) and abs(right - got) <= step / 10
    # An integer that no float can hold.
    except OverflowError:
        return False


def _stream(
    right: Sequence[list[Json]], answer: Json, can: Collection[str]
) -> Iterator[Observation]:
    got = answer.get("events")
    if not _is_stream(got):
        yield Observation(
            STREAM_FRAMES, f"expected lists of events, but the answer was {_shown(answer)}"
        )
        return
    assert isinstance(got, list), "checked before"
    yield Observation(STREAM_FRAMES, _differ(_frames(right), _frames(got)))
    differ = (_differ(_frames([a]), _frames([b])) for a, b in zip(right, got))
    late = next((f"chunk {at}: {detail}" for at, detail in enumerate(differ) if detail), "")
    counts = f"{len(right)} chunks, but {len(got)} lists of events"
    yield Observation(STREAM_CHUNKS, late if len(right) == len(got) else counts)
    if "noise" in can:
        yield Observation(STREAM_NOISE, _differ(_noise(right, False), _noise(got, False)))
        if "reasons" in can:
            yield Observation(NOISE_REASON, _differ(_noise(right, True), _noise(got, True)))


def _is_stream(got: Any) -> bool:
    return isinstance(got, list) and all(
        isinstance(chunk, list)
        and all(isinstance(e, dict) and isinstance(e.get("offset"), int) for e in chunk)
        for chunk in got
    )


def _frames(chunks: Sequence[list[Json]]) -> list[str]:
    return [
        f"{str(event['frame']).upper()} at {event['offset']}"
        for chunk in chunks
        for event in chunk
        if "frame" in event
    ]


def _noise(chunks: Sequence[list[Json]], reasons: bool) -> list[str]:
    """Return the spans, joined where they touch, so that the limits of chunks do not matter."""
    spans: list[tuple[int, str, str]] = []
    for event in (event for chunk in chunks for event in chunk if "noise" in event):
        data, at = str(event["noise"]).upper(), event["offset"]
        reason = str(event.get("reason")) if reasons else "noise"
        last = spans[-1] if spans else (0, "", "")
        if spans and last[2] == reason and last[0] + len(last[1]) // 2 == at:
            spans[-1] = (last[0], last[1] + data, reason)
        else:
            spans.append((at, data, reason))
    return [f"{reason} {data} at {at}" for at, data, reason in spans]


def _differ(right: list[str], got: list[str]) -> str:
    """Return the first difference of two lists, in words."""
    if right == got:
        return ""
    at = next((i for i, pair in enumerate(zip(right, got)) if pair[0] != pair[1]), None)
    at = min(len(right), len(got)) if at is None else at
    wanted = right[at] if at < len(right) else "nothing more"
    found = got[at] if at < len(got) else "nothing more"
    return f"expected {wanted}, got {found}"


def _shown(answer: Json) -> str:
    text = ", ".join(f"{name} {value}" for name, value in answer.items() if name != "id")
    return (text[:200] or "nothing").rstrip()
