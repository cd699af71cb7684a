"""Reports wrong arguments under the names of the maker's library."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from cobotwire.protocol.errors import UsageError

P = ParamSpec("P")
Result = TypeVar("Result")


def naming(**names: str) -> Callable[[Callable[P, Result]], Callable[P, Result]]:
    """Let a method's UsageErrors name the library's parameters: ``naming(joint="id")``.

    Args:
        names: for arguments of our method, the parameters that the caller wrote.
    """

    def named(method: Callable[P, Result]) -> Callable[P, Result]:
        @wraps(method)
        def called(*args: P.args, **kwargs: P.kwargs) -> Result:
            try:
                return method(*args, **kwargs)
            except UsageError as error:
                raise error.renamed(names) from None

        return called

    return named
