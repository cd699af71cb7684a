"""Answers against what is right: which rules an answer touches, and what it does wrong."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import Any, NamedTuple

from cobotwire.conformance.codec.trials import Json, Trial
from cobotwire.table import Table

RULES: dict[str, str] = {
    "encode-bytes": "values become exactly these bytes; between two steps, the nearest",
    "encode-refuses": "a value that the field does not allow becomes no bytes",
    "decode-values": "a legal frame reads as the values that it holds",
    "decode-refuses": "what is no legal frame, or holds what no field allows, is refused",
    "refusal-reason": "a refusal names its reason, and the byte",
    "stream-frames": "every undamaged frame is found, at its offset, and none that is not there",
    "stream-chunks": "a frame comes with the chunk, or the silence, that makes it certain",
    "stream-noise": "every byte that is in no frame is told as noise, once",
    "noise-reason": "noise names the reason for which its bytes were refuted",
    "answers": "every question is answered, in time, by one line that says so",
}
# Rules that ask for more than a codec must tell; the greeting says whether this one does.
ABILITIES = {
    "refusal-reason": "reasons",
    "noise-reason": "reasons",
    "stream-noise": "noise",
}


class Finding(NamedTuple):
    """A rule that an answer was held to; ``complaint`` is empty where it was kept."""

    rule: str
    complaint: str


def judge(table: Table, trial: Trial, answer: Json, can: Collection[str]) -> Iterator[Finding]:
    """What an answer says about each rule that its trial is about."""
    expect = trial.expect
    if "events" in expect:
        yield from _stream(expect["events"], answer, can)
    elif "refused" in expect:
        yield from _refusal(trial, answer, can)
    elif "bytes" in expect:
        yield Finding(trial.rule, _bytes(expect["bytes"], answer))
    else:
        yield Finding(trial.rule, _values(table, trial, answer))


def _bytes(right: str, answer: Json) -> str:
    given = answer.get("bytes")
    if not isinstance(given, str):
        return f"expected {right}, but it said {_said(answer)}"
    plain = "".join(given.split()).upper()
    return "" if plain == right else f"expected {right}, got {plain}"


def _refusal(trial: Trial, answer: Json, can: Collection[str]) -> Iterator[Finding]:
    right, why = trial.expect["refused"], trial.expect.get("why", "")
    if "error" not in answer:
        yield Finding(trial.rule, f"expected a refusal ({why}), but it said {_said(answer)}")
        return
    yield Finding(trial.rule, "")
    if "reasons" not in can or trial.rule == "encode-refuses":
        return
    expected = (right, trial.expect["offset"])
    given = (answer["error"], answer.get("offset"))
    wrong = f"expected {expected[0]} at byte {expected[1]}, got {given[0]} at byte {given[1]}"
    yield Finding("refusal-reason", "" if given == expected else wrong)


def _values(table: Table, trial: Trial, answer: Json) -> str:
    right, given = trial.expect, answer.get("fields")
    if not isinstance(given, dict):
        return f"expected {right['fields']}, but it said {_said(answer)}"
    if answer.get("command") != right["command"]:
        return f"expected {right['command']}, read as {answer.get('command')}"
    # An echo says only whose reply it is; who has asked need not tell it.
    needed = set(right["fields"]) - _echoes(table, right["command"])
    if not needed <= set(given) <= set(right["fields"]):
        return f"expected the fields {sorted(right['fields'])}, got {sorted(given)}"
    steps = _steps(table, right["command"], trial.ask["direction"])
    for name, value in right["fields"].items():
        if name in given and not _alike(value, given[name], steps.get(name, 1.0)):
            return f"{name}: expected {value}, got {given[name]}"
    return ""


def _echoes(table: Table, name: str) -> set[str]:
    reply = table.command(name).reply
    return {field.name for layout in reply for field in layout.fields if field.echo}


def _steps(table: Table, name: str, direction: Any) -> dict[str, float]:
    """The finest step of each field: nobody need compute as exactly as Python does."""
    return {
        field.name: min(n.multiply / n.divide for case in field.cases for n in case.numbers)
        for layout in table.command(name).layouts(direction)
        for field in layout.fields
    }


def _alike(right: Any, given: Any, step: float) -> bool:
    if isinstance(right, list):
        return (
            isinstance(given, list)
            and len(right) == len(given)
            and all(_alike(a, b, step) for a, b in zip(right, given))
        )
    return isinstance(given, int | float) and abs(right - given) <= step / 10


def _stream(right: Sequence[list[Json]], answer: Json, can: Collection[str]) -> Iterator[Finding]:
    given = answer.get("events")
    if not _is_stream(given):
        yield Finding("stream-frames", f"expected lists of events, but it said {_said(answer)}")
        return
    assert isinstance(given, list), "checked before"
    yield Finding("stream-frames", _differ(_frames(right), _frames(given)))
    if len(right) == len(given):
        late = next((i for i, pair in enumerate(zip(right, given)) if _late(*pair)), None)
        detail = (
            ""
            if late is None
            else f"chunk {late}: " + _differ(_frames([right[late]]), _frames([given[late]]))
        )
        yield Finding("stream-chunks", detail)
    else:
        yield Finding("stream-chunks", f"{len(right)} chunks, but {len(given)} lists of events")
    if "noise" in can:
        yield Finding("stream-noise", _differ(_noise(right, False), _noise(given, False)))
        if "reasons" in can:
            yield Finding("noise-reason", _differ(_noise(right, True), _noise(given, True)))


def _is_stream(given: Any) -> bool:
    return isinstance(given, list) and all(
        isinstance(chunk, list)
        and all(isinstance(e, dict) and isinstance(e.get("offset"), int) for e in chunk)
        for chunk in given
    )


def _late(right: list[Json], given: list[Json]) -> bool:
    return _frames([right]) != _frames([given])


def _frames(chunks: Sequence[list[Json]]) -> list[str]:
    return [
        f"{str(event['frame']).upper()} at {event['offset']}"
        for chunk in chunks
        for event in chunk
        if "frame" in event
    ]


def _noise(chunks: Sequence[list[Json]], reasons: bool) -> list[str]:
    """The spans, joined where they touch: how a stream was cut must not show."""
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


def _differ(right: list[str], given: list[str]) -> str:
    """The first difference of two lists, in words."""
    if right == given:
        return ""
    at = next((i for i, pair in enumerate(zip(right, given)) if pair[0] != pair[1]), None)
    at = min(len(right), len(given)) if at is None else at
    wanted = right[at] if at < len(right) else "nothing more"
    got = given[at] if at < len(given) else "nothing more"
    return f"expected {wanted}, got {got}"


def _said(answer: Json) -> str:
    text = ", ".join(f"{name} {value}" for name, value in answer.items() if name != "id")
    return (text[:200] or "nothing").rstrip()
