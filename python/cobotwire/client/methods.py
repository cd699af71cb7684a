"""Reuse a method in a generated class, with its docstring."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from functools import wraps
from typing import Any, Concatenate, ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")


def shared(method: Callable[Concatenate[Any, P], R]) -> Callable[Concatenate[Any, P], R]:
    """Return a method of the base edition's class, for the class of a delta.

    The class of a delta does not inherit from that of the base, because it would also inherit the
    methods that the delta withdraws.
    """
    return method


def asynchronous(
    method: Callable[Concatenate[Any, P], R],
) -> Callable[Concatenate[Any, P], Coroutine[Any, Any, R]]:
    """Return the method of an asyncio client that does what a generated blocking method does.

    A generated method returns what ``_call`` or ``_send`` of its client returns, which callers of
    an asyncio client await.
    """
    generated: Callable[..., Any] = method

    # The asyncio method gets the arguments and the docstring of the blocking one.
    @wraps(method)
    async def call(*arguments: Any, **named: Any) -> Any:
        return await generated(*arguments, **named)

    return call
