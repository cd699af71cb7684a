"""Compare every method of the maker's classes with the method of ours that sends the same message.

The arguments are the corners of our own table, and a value between them: the lowest and the highest
value of every field, for each value of its selector.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from cobotwire.editions import load
from cobotwire.protocol.table import Command, Field, Table, Variant
from pymycobot_280_requests import as_called, corners, end
from pymycobot_classes import CLASSES, REJECTIONS, recording_client, without_port, written
from pymycobot_robot_rulings import LOCAL, METHODS, RULINGS

EDITIONS = {"MechArm270": "mecharm270", "MyCobot280RDKX5": "mycobot280_rdkx5"}


class Compared(NamedTuple):
    """A method, and what its calls showed: how many are equal, ruled and open."""

    method: str
    equal: int
    ruled: int
    open: list[str]


def compare_methods(kind: str, methods: Iterable[str]) -> list[Compared]:
    """Return what methods of one of the maker's classes showed."""
    table = load(EDITIONS[kind]).TABLE
    ours = {METHODS[kind].get(c.name, c.name): c for c in table.commands}
    return [_method(kind, method, ours.get(method)) for method in methods]


def compare(kind: str) -> list[Compared]:
    """Return what each public method of one of the maker's classes showed."""
    public = (name for name in dir(CLASSES[kind]) if not name.startswith("_"))
    return compare_methods(kind, (name for name in public if name not in LOCAL[kind]))


def _method(kind: str, method: str, command: Command | None) -> Compared:
    if (kind, method) in RULINGS and command is None:
        return Compared(method, 0, 1, [])
    if command is None:
        return Compared(method, 0, 0, ["no command of the edition has this name"])
    equal, ruled, left = 0, 0, []
    ruling = RULINGS.get((kind, method))
    for arguments in _arguments(command):
        request = written(_client(kind), command.name, arguments)
        theirs: bytes | str
        try:
            theirs = written(without_port(kind), method, arguments)
        except REJECTIONS as error:
            theirs = f"rejected: {error}"
        shown = theirs if isinstance(theirs, str) else theirs.hex(" ")
        if theirs == request:
            equal += 1
        elif ruling is not None and ruling.shows in shown:
            ruled += 1
        else:
            left.append(f"{arguments}: {shown}; ours: {request.hex(' ')}")
    return Compared(method, equal, ruled, left)


def _client(kind: str) -> Any:
    return recording_client("reference", load(EDITIONS[kind]).CLIENT)


def _arguments(command: Command) -> Iterator[tuple[Any, ...]]:
    if command.request_text is not None:
        yield "home", "secret words"
        return
    for variant in command.request:
        values = [*corners(variant), *between(variant)]
        yield from (as_called(command.name, variant, each) for each in values)


def between(variant: Variant) -> Iterator[tuple[Any, ...]]:
    """Return one value inside of the corners, in whole units, for the lowest selector."""
    selectors = {field.selector for field in variant.fields} - {-1}
    picks = [min((w for c in f.cases for w in c.when), default=None) for f in variant.fields]
    pick = next((each for each in picks if each is not None), None)
    yield tuple(
        pick if index in selectors else _middle(field, pick)
        for index, field in enumerate(variant.fields)
    )


def _middle(field: Field, pick: int | None) -> Any:
    low, high = end(field, False, pick), end(field, True, pick)
    if field.choices:
        return low
    if isinstance(low, tuple):
        return tuple(float(int((a + b) / 2)) for a, b in zip(low, high, strict=True))
    return type(low)(int((low + high) / 2))


def unlisted(kind: str) -> set[str]:
    """Return our commands that the maker's class has no method for."""
    table: Table = load(EDITIONS[kind]).TABLE
    names = {METHODS[kind].get(command.name, command.name) for command in table.commands}
    return {name for name in names if not hasattr(CLASSES[kind], name)}


def main() -> int:
    """Print the table; return 1 if a difference has no ruling."""
    print("| class | methods | equal | ruled | open |\n|---|--:|--:|--:|--:|")
    left = []
    for kind in EDITIONS:
        found = compare(kind)
        ruled = sum(1 for each in found if each.ruled and not each.open)
        opened = [each for each in found if each.open]
        equal = len(found) - ruled - len(opened)
        print(f"| {kind} | {len(found)} | {equal} | {ruled} | {len(opened)} |")
        left += [f"{kind}.{each.method}: {text}" for each in opened for text in each.open]
    print("\n".join(left))
    return 1 if left else 0


if __name__ == "__main__":
    raise SystemExit(main())
