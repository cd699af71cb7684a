"""Arrange the arguments of a message, and choose the variant that takes those that are given.

A row is one variant as its message class knows it, in the order of the wire: the names of the
arguments, pairs of a name and its default, and constants.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, NamedTuple

from cobotwire.protocol.error_texts import error_text

Row = tuple[Any, ...]


class Chosen(NamedTuple):
    """A variant that takes the given arguments.

    Attributes:
        first: its index among the variants.
        variant: the index of the variant; None if several take the same arguments, so that the
            codec decides by the values.
        wire: the names of its arguments, and its constants, in the order of the wire.
        defaults: the defaults of the arguments that are not given.
    """

    first: int
    variant: int | None
    wire: Row
    defaults: dict[str, Any]


def choose(call: str, rows: tuple[Row, ...], given: Collection[str]) -> Chosen:
    """Return the variant that takes exactly the given arguments.

    Raises:
        TypeError: no variant does; the text names an argument at fault and what is legal.
    """
    fitting = [i for i, row in enumerate(rows) if not _missing(row, given) + _odd(row, given)]
    if not fitting:
        raise TypeError(misfit(call, rows, given))
    row = rows[fitting[0]]
    return Chosen(
        fitting[0],
        fitting[0] if len(fitting) == 1 else None,
        tuple([part[0] if isinstance(part, tuple) else part for part in row]),
        {part[0]: part[1] for part in row if isinstance(part, tuple) and part[0] not in given},
    )


def misfit(call: str, rows: tuple[Row, ...], given: Collection[str]) -> str:
    """Return the text of the error that no variant takes exactly the given arguments."""
    nearest = min(rows, key=lambda row: len(_missing(row, given)) + len(_odd(row, given)))
    forms = [*dict.fromkeys(map(_shown, rows))]
    either = error_text("or").join([f"({form})" for form in forms])
    allowed = forms[0] if len(forms) == 1 else either
    odd = _odd(nearest, given)
    if odd:
        others = [name for name in given if name != odd[0]]
        beside, kind = error_text("and").join(others), "odd-beside" if others else "odd-argument"
        return error_text(kind, call=call, name=odd[0], others=beside, allowed=allowed)
    name = _missing(nearest, given)[0]
    return error_text("missing-argument", call=call, name=name, allowed=allowed)


def _missing(row: Row, given: Collection[str]) -> list[str]:
    return [part for part in row if isinstance(part, str) and part not in given]


def _odd(row: Row, given: Collection[str]) -> list[str]:
    taken = {part[0] if isinstance(part, tuple) else part for part in row}
    return [name for name in given if name not in taken]


def _shown(row: Row) -> str:
    words = [
        f"{part[0]}={part[1]}" if isinstance(part, tuple) else part
        for part in row
        if isinstance(part, str | tuple)
    ]
    return ", ".join(words) or error_text("no-arguments")


def arranged(
    message: type, names: tuple[str, ...], arguments: tuple[Any, ...], named: Mapping[str, Any]
) -> list[Any]:
    """Return the arguments of a message in the order of its fields; defaults are class attributes.

    Raises:
        TypeError: an argument is missing, unknown, or given twice.
    """
    if len(arguments) > len(names):
        raise TypeError(f"{message.__name__}() takes {len(names)} arguments, not {len(arguments)}")
    given = dict(zip(names, arguments))
    for name in named:
        if name not in names:
            raise TypeError(f"{message.__name__}() has no argument {name}")
        if name in given:
            raise TypeError(f"{message.__name__}() got its argument {name} twice")
    given.update(named)
    for name in names:
        if name not in given:
            if name not in message.__dict__:
                raise TypeError(f"{message.__name__}() is missing its argument {name}")
            given[name] = message.__dict__[name]
    return [given[name] for name in names]
