"""States facts of the transport, and defaults of arguments, as the maker's library has them."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from functools import lru_cache

from cobotwire_codegen.model import Edition
from pymycobot_classes import library

MAKER = library("MyCobot280")


@lru_cache(maxsize=1)
def _baudrate() -> int:
    """Return the rate at which the library opens a port unless it is told another."""
    return int(inspect.signature(MAKER.__init__).parameters["baudrate"].default)


@lru_cache(maxsize=1)
def _wait_ms() -> int:
    """Return how long the library waits for the reply to a request, unless it knows better."""
    found = re.search(r"\belse:\s+wait_time = ([\d.]+)", inspect.getsource(MAKER._read))
    assert found, "the library states its default wait"
    return round(float(found[1]) * 1000)


def transport(edition: Edition) -> Iterator[str]:
    """Report another baud rate or deadline than the library uses."""
    if edition.frame.baudrate != _baudrate():
        yield f"{edition.frame.baudrate} baud; the maker's library opens ports at {_baudrate()}"
    if edition.frame.deadline_ms != _wait_ms():
        yield f"{edition.frame.deadline_ms} ms; the maker's library waits {_wait_ms()} ms"
    for command in edition.commands:
        if command.deadline_ms != _wait_ms():
            yield f"{command.name} has a deadline of its own"


def defaults(edition: Edition) -> Iterator[str]:
    """Report arguments with another default than those of the library's method, or without one.

    A command of the library's name has its arguments in the library's order.
    """
    for command in edition.commands:
        theirs = _defaults(command.name)
        fields = [f for variant in command.requests[:1] for f in variant if f.const is None]
        for field, default in zip(fields, theirs):
            ours = None if field.default is None else field.default[0]
            if ours != default:
                yield f"{command.name}: {field.name} has the default {ours}; the library {default}"


@lru_cache(maxsize=1024)
def _defaults(name: str) -> tuple[int | None, ...]:
    """Return the defaults of a method of the library; None where an argument has none."""
    method = getattr(MAKER, name, None)
    given = [] if method is None else list(inspect.signature(method).parameters.values())[1:]
    return tuple(None if p.default in (p.empty, None) else int(p.default) for p in given)


RULES = (transport, defaults)
