"""What reads a setting back is a query of the edition that tells it."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen.errors import Problem, nearest
from cobotwire_codegen.model import Command, Edition, ReadBack


def read_back_fits(edition: Edition) -> Iterator[Problem]:
    """The query is there, its reply has the fields, and the command the arguments."""
    known = {command.name: command for command in edition.commands}
    for command in edition.commands:
        back = command.read_by
        if back is None:
            continue
        query = known.get(back.query)
        if query is None or query.safety != "query":
            hint = nearest(back.query, (c.name for c in edition.commands if c.safety == "query"))
            message = f"{command.name} is read by {back.query}, which is no query here{hint}"
            yield Problem(back.place, "bad-read-back", message)
        else:
            yield from _fields(command, back, query)


def _fields(command: Command, back: ReadBack, query: Command) -> Iterator[Problem]:
    told = {field.name for form in query.replies for field in form}
    told |= {name for name, _ in query.text.fields} if query.text else set()
    given = {field.name for form in command.requests for field in form}
    given |= {name for name, _ in command.request_text.fields} if command.request_text else set()
    for name, said in back.fields or ((name, name) for name in sorted(told & given)):
        if name not in told:
            message = f"the reply of {query.name} has no field {name}{nearest(name, told)}"
            yield Problem(back.place, "bad-read-back", message)
        if isinstance(said, str) and said not in given:
            message = f"{command.name} has no argument {said}{nearest(said, given)}"
            yield Problem(back.place, "bad-read-back", message)
    if not back.fields and not told & given:
        message = f"{command.name} and {query.name} have no field of the same name"
        yield Problem(back.place, "bad-read-back", message)


RULES = (read_back_fits,)
