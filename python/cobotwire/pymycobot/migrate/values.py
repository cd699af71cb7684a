"""What an expression of a program may be, as far as a rewritten call depends on it."""

from __future__ import annotations

from typing import NamedTuple


class Kind(NamedTuple):
    """A class of the library; ``ours``: its counterpart here, in a program that was rewritten."""

    name: str
    ours: bool = False


class Arm(NamedTuple):
    """An object of a class of the library, or of its counterpart here."""

    kind: str
    ours: bool = False


class Result(NamedTuple):
    """The result of a query of an arm; ``form`` is that of ``Call.gives``."""

    form: str


class Instance(NamedTuple):
    """An object of a class of the program, by the key of the class."""

    key: tuple[object, ...]


class Other(NamedTuple):
    """``None``, or anything else that is not known here."""

    is_none: bool


NONE, UNKNOWN = Other(True), Other(False)
Value = Kind | Arm | Result | Instance | Other
Values = frozenset[Value]
