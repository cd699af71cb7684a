"""Draw several variants of a message, constants, defaults and orders of arguments."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from cobotwire_codegen.model import Command, Edition, Field
from random_values import as_yaml, of_field

Record = dict[str, Any]


@st.composite
def several_variants(draw: st.DrawFn, direction: str, kinds: list[str]) -> list[list[Record]]:
    """Draw two or three variants of a message with different arguments.

    Each has another constant, or else another length.
    """
    if draw(st.integers(0, 2)) == 0:
        return [[{"name": "a", "type": "joint"}], [{"name": "b", "type": "wide"}]]
    variants: list[list[Record]] = []
    for tag in range(draw(st.integers(2, 3))):
        names = draw(st.lists(st.sampled_from("abc"), max_size=3, unique=True))
        if any({f["name"] for f in known} == {"tag", *names} for known in variants):
            continue
        fields = [{"name": name, "type": draw(st.sampled_from(kinds))} for name in names]
        constant = {"name": "tag", "type": "tag", "const": tag + 1}
        variants.append([constant, *fields])
    if len(variants) < 2 or direction == "reply":
        # The reply of a query must carry something.
        for variant in variants:
            variant.append({"name": "d", "type": draw(st.sampled_from(kinds))})
    if len(variants) < 2:
        variants.append([{"name": "tag", "type": "tag", "const": 9}])
    return variants


@st.composite
def sharing_queries(draw: st.DrawFn, id: int, kinds: list[str]) -> dict[str, Record]:
    """Draw two queries of one id; a constant tells their requests and their replies apart."""
    made: dict[str, Record] = {}
    for index, name in enumerate(("one", "other")):
        tag = {"name": "tag", "type": "tag", "const": 7 + index}
        bus = {"name": "bus", "type": "joint"}
        answer = {"name": "answer", "type": draw(st.sampled_from(kinds))}
        made[name] = {
            "id": id,
            "title": "A query",
            "doc": "Asks.",
            "safety": "query",
            "request": [tag, bus],
            "reply": [{**bus, "echo": "required"}, tag, answer],
        }
    made["other"]["shares_id"] = "one"
    return made


def draw_arguments(draw: Any, data: Record, edition: Edition) -> None:
    """Draw defaults for some arguments, and an order for some methods, into a spec's data."""
    for command in edition.commands:
        record = data["commands"][command.name]
        rows = record.get("request_variants") or [record.get("request", [])]
        full = command.requests[: len(rows)]
        needed = [{f.name for f in variant if f.const is None and not f.counts} for variant in full]
        for index, (variant, row) in enumerate(zip(full, rows)):
            for field, entry in zip(variant, row):
                # A default is a number, a word, or the numbers of a value type.
                plain = entry.keys() == {"name", "type"} and bool(field.type.parts)
                plain = plain and not field.counts and not _selects(field, variant)
                if plain and draw(st.booleans()) and _stay_apart(full, needed, index, field):
                    needed[index].discard(field.name)
                    entry["default"] = as_yaml(draw(of_field(field, field.type)))
        if draw(st.booleans()):
            _draw_order(draw, record, command, full, needed)


def _selects(field: Field, variant: tuple[Field, ...]) -> bool:
    return any(other.selector == field.name for other in variant)


def _stay_apart(
    full: tuple[tuple[Field, ...], ...], needed: list[set[str]], index: int, field: Field
) -> bool:
    """Return whether each call fits only one variant, also if ``field`` of one has a default."""
    names = [{f.name for f in variant if f.const is None and not f.counts} for variant in full]
    rest = needed[index] - {field.name}
    return all(
        not (rest | needed[other] <= names[index] & names[other])
        for other in range(len(full))
        if other != index
    )


def _draw_order(
    draw: Any,
    record: Record,
    command: Command,
    full: tuple[tuple[Field, ...], ...],
    needed: list[set[str]],
) -> None:
    names = {f.name for variant in full for f in variant if f.const is None and not f.counts}
    optional = {f.name for variant in full for f in variant if f.optional}
    always = sorted(set.intersection(*needed) - optional) if needed else []
    others = sorted(names - {*always})
    if names:
        order = [*draw(st.permutations(always)), *draw(st.permutations(others))]
        record["arguments"] = order
