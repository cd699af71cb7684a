"""The kinds of faults, by the names that scenario files use."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from cobotwire.simulator.faults.fault import Fault

KINDS: dict[str, type[Fault]] = {}

Kind = TypeVar("Kind", bound=type[Fault])


def kind(name: str) -> Callable[[Kind], Kind]:
    """Register a class of faults under a name."""

    def register(cls: Kind) -> Kind:
        if name in KINDS:
            raise ValueError(f"two faults are called {name}")
        cls.kind = name
        KINDS[name] = cls
        return cls

    return register
