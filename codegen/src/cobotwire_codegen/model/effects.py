"""The state of an edition, and what commands do with it."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire_codegen.errors import Place
from cobotwire_codegen.model.shapes import Type


@dataclass(frozen=True, slots=True)
class State:
    """One item of the state of an arm.

    ``type`` is None for a text. ``each`` names the types of its indices, and there is a value for
    each index; if ``each`` is empty, there is a single value. ``start`` is the value with which a
    simulated arm starts, as the spec states it; None: zero, or an empty text.
    """

    place: Place
    name: str
    type: Type | None
    each: tuple[str, ...]
    start: object


@dataclass(frozen=True, slots=True)
class Effect:
    """What a command does: a verb, which is the kind of effect, and what it applies to.

    Attributes:
        place: where the spec states it.
        verb: ``reports``, ``stores``, ``sets``, ``moves``, ``zeroes``, ``does``, ``list``,
            ``computes``, ``unknown``, ``python``, or ``selector`` for an effect in cases.
        what: depending on the verb, the part that moves, the list, the computed value, the
            description, the reason, or the selector.
        values: of ``reports`` and ``stores``: each field with its state; of ``sets``: each state
            with its value.
        at: the arguments that choose one index.
        options: the other keys with their values, such as ``speed`` and its argument.
        cases: the effect for each value of the selector.
        assumed: why no source states the effect; empty if a source does.
        by_role: whether the effect follows from the command's role and is not in the spec.
    """

    place: Place
    verb: str
    what: str = ""
    values: tuple[tuple[str, object], ...] = ()
    at: tuple[str, ...] = ()
    options: tuple[tuple[str, object], ...] = ()
    cases: tuple[tuple[str, Effect], ...] = ()
    assumed: str = ""
    by_role: bool = False

    def option(self, name: str) -> object:
        """Return the value of a key; None if it is left out."""
        return dict(self.options).get(name)
