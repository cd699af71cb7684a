"""Rules for `samples` and `agrees_with`: they name existing arguments and queries."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen.errors import Problem, nearest
from cobotwire_codegen.model import Edition


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
    """Report `agrees_with` entries if one of the two commands is not a query."""
    queries = {command.name for command in edition.commands if command.safety == "query"}
    for command in edition.commands:
        for name in command.agrees_with:
            if command.name not in queries or name not in queries:
                wrong = command.name if command.name not in queries else name
                hint = nearest(wrong, queries)
                message = f"{command.name} agrees with {name}, but {wrong} is not a query{hint}"
                yield Problem(command.place, "bad-agreement", message)


RULES = (samples_fit, agreement_fits)
