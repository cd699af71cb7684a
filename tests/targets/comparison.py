"""The result of testing a target: how much was compared, and what differed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple


class Comparison(NamedTuple):
    """How much was compared for an edition, and every difference in words.

    ``refused`` counts the vectors with values or bytes that must be refused.
    """

    vectors: int
    fields: int
    differences: list[str]
    refused: int = 0


def compared(
    document: dict[str, Any], comparers: Mapping[str, Callable[[dict[str, Any]], Iterable[str]]]
) -> Comparison:
    """Compare the records of a document by its parts; a comparer yields the differences of one."""
    records = {part: document.get(part, []) for part in comparers}
    differences = [
        f"{part}: {record.get('name', record.get('command'))}: {difference}"
        for part, compare in comparers.items()
        for record in records[part]
        for difference in compare(record)
    ]
    fields = sum(len(f["raw"]) for record in document["messages"] for f in record["fields"])
    refused = sum(len(records.get(part, ())) for part in ("rejected", "malformed"))
    return Comparison(sum(map(len, records.values())), fields, differences, refused)


class ToolMissing(Exception):
    """A tool is not installed; the message names it and how to install it."""
