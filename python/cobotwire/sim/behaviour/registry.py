"""The register of behaviours.

A behaviour takes the arm's state, the time and the request's fields by name, and gives the reply's
fields by name, or None. Echoed fields are filled in by the arm.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Behaviour = Callable[..., dict[str, Any] | None]

BEHAVIOUR: dict[str, Behaviour] = {}


def does(name: str) -> Callable[[Behaviour], Behaviour]:
    """Register a function as the behaviour of the command called ``name``."""

    def register(behaviour: Behaviour) -> Behaviour:
        if name in BEHAVIOUR:
            raise ValueError(f"{name} has a behaviour already")
        BEHAVIOUR[name] = behaviour
        return behaviour

    return register
