"""Rules for `read_by`, `samples` and `agrees_with`: they name existing queries and fields."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen.errors import Problem, nearest
from cobotwire_codegen.model import Command, Edition, ReadBack


def read_back_fits(edition: Edition) -> Iterator[Problem]:
    """Report `read_by` entries whose query, reply fields or arguments do not exist."""
    known = {command.name: command for command in edition.commands}
    for command in edition.commands:
        back = command.read_by
        if back is None:
            continue
        query = known.get(back.query)
        if query is None or query.safety != "query":
            hint = dict(edition.gone).get(back.query) or nearest(
                back.query, (c.name for c in edition.commands if c.safety == "query")
            )
            message = f"read_by of {command.name} names {back.query}, which is not a query{hint}"
            yield Problem(back.place, "bad-read-back", message)
        else:
            yield from _fields(command, back, query)


def _fields(command: Command, back: ReadBack, query: Command) -> Iterator[Problem]:
    reported = {field.name for variant in query.replies for field in variant}
    reported |= {name for name, _ in query.text.fields} if query.text else set()
    given = {field.name for variant in command.requests for field in variant}
    given |= {name for name, _ in command.request_text.fields} if command.request_text else set()
    for name, argument in back.fields or ((name, name) for name in sorted(reported & given)):
        if name not in reported:
            message = f"the reply of {query.name} has no field {name}{nearest(name, reported)}"
            yield Problem(back.place, "bad-read-back", message)
        if isinstance(argument, str) and argument not in given:
            message = f"{command.name} has no argument {argument}{nearest(argument, given)}"
            yield Problem(back.place, "bad-read-back", message)
    if not back.fields and not reported & given:
        message = f"{command.name} and {query.name} have no field of the same name"
        yield Problem(back.place, "bad-read-back", message)


def samples_fit(edition: Edition) -> Iterator[Problem]:
    """Report samples for arguments that no variant of the request has."""
    for command in edition.commands:
        variants = [{field.name for field in variant} for variant in command.requests]
        for samples in command.samples:
            names = {name for name, _ in samples}
            if not any(names <= variant for variant in variants):
                message = (
                    f"no request of {command.name} has the arguments {', '.join(sorted(names))}"
                )
                yield Problem(command.place, "bad-samples", message)


def agreement_fits(edition: Edition) -> Iterator[Problem]:
    """Report `agrees_with` entries that are not between queries."""
    queries = {command.name for command in edition.commands if command.safety == "query"}
    for command in edition.commands:
        for name in command.agrees_with:
            if command.name not in queries or name not in queries:
                wrong = command.name if command.name not in queries else name
                hint = nearest(wrong, queries)
                message = f"{command.name} agrees with {name}, but {wrong} is not a query{hint}"
                yield Problem(command.place, "bad-agreement", message)


RULES = (read_back_fits, samples_fit, agreement_fits)
