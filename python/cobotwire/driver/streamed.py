"""What a stream asks: checked once, when it is made; and how replies become the methods' values."""

from __future__ import annotations

from collections.abc import Callable, Coroutine, Sequence
from typing import Any

from cobotwire.errors import UsageError
from cobotwire.session import Question, Request
from cobotwire.session.sample import Query, Reading
from cobotwire.table import Table

Prepare = Callable[[str, Sequence[Any]], Request]


class Streamed:
    """One query of a stream: the request is spelt once, and sent in each slot.

    Both clients' generated methods do the rest: they know what arguments stand for on the wire and
    what a reply means. Here they run without a line.
    """

    def __init__(self, query: Query, method: Any, arguments: tuple[Any, ...], prepare: Prepare):
        """Raises UsageError: the arguments are not allowed."""
        self.query = query
        self._method = method
        self._arguments = arguments
        self.request = self._spelt(prepare)

    def reading(self, question: Question) -> Reading:
        """What the method would have returned, with its times."""
        assert question.asked_at is not None, "what is answered was asked"
        assert question.answered_at is not None, "a question without an answer has raised"
        value = self._value(question.result())
        return Reading(value, question.asked_at, question.answered_at)

    def _value(self, fields: dict[str, Any]) -> Any:
        work = self._method(_Replay(fields), *self._arguments)
        if not isinstance(work, Coroutine):
            return work
        try:
            work.send(None)
        except StopIteration as over:
            return over.value
        raise AssertionError("a method that waits for more than its reply")

    def _spelt(self, prepare: Prepare) -> Request:
        speller = _Speller(prepare)
        try:
            work = self._method(speller, *self._arguments)
            if isinstance(work, Coroutine):
                work.send(None)
        except _SpeltError as spelt:
            return spelt.request
        except TypeError as error:
            raise UsageError("query", self.query, f"what its method takes: {error}") from None
        raise AssertionError("a query's method asks")


class _SpeltError(Exception):
    """Not an error: the method has come so far as to ask."""

    def __init__(self, request: Request) -> None:
        self.request = request


class _Speller:
    """Takes the place of a client until a method asks."""

    def __init__(self, prepare: Prepare) -> None:
        self._prepare = prepare

    def _ask(self, name: str, values: Sequence[Any]) -> Any:
        raise _SpeltError(self._prepare(name, values))


class _Replay:
    """Takes the place of a client when the reply has come."""

    def __init__(self, fields: dict[str, Any]) -> None:
        self._fields = _Awaitable(fields)

    def _ask(self, name: str, values: Sequence[Any]) -> _Awaitable:
        return self._fields


class _Awaitable(dict[str, Any]):
    """A reply's fields for either kind of method: `await` gives them at once."""

    def __await__(self) -> Any:
        return self
        yield  # what makes this a generator, as `await` wants it


def streamed(
    client: type, table: Table, queries: Sequence[Query], prepare: Prepare
) -> tuple[Streamed, ...]:
    """The queries of a stream, checked.

    Raises:
        UsageError: there is none, one stands twice, is no query, or its arguments are not allowed.
    """
    if not queries:
        raise UsageError("queries", queries, _allowed(table))
    found: list[Streamed] = []
    for index, query in enumerate(queries):
        name, *arguments = query if isinstance(query, tuple) and query else (query,)
        if not isinstance(name, str):
            raise UsageError(f"queries[{index}]", query, "a name, or a tuple of it and arguments")
        command = table.command(name)
        if command.safety != "query" or not command.answers:
            raise UsageError(f"queries[{index}]", query, _allowed(table))
        known: Query = (name, *arguments) if arguments else name
        if any(known == other.query for other in found):
            raise UsageError(f"queries[{index}]", query, "each query once")
        found.append(Streamed(known, getattr(client, name), tuple(arguments), prepare))
    return tuple(found)


def _allowed(table: Table) -> str:
    queries = [c.name for c in table.commands if c.safety == "query" and c.answers]
    return f"queries, which are {', '.join(queries)}"
