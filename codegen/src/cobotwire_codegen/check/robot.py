"""Rules for what an edition states about its robot."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen.errors import Problem
from cobotwire_codegen.model import Edition
from cobotwire_codegen.start_values import raw_start_values, reported_fields


def start_values_fit(edition: Edition) -> Iterator[Problem]:
    """Report start values of commands that are no queries, or that their replies cannot carry."""
    commands = {command.name: command for command in edition.commands}
    for stated in edition.robot.start_values:
        command = commands.get(stated.query)
        if command is None:
            message = edition.no_command(stated.query)
            yield Problem(stated.place, "unknown-command", message)
            continue
        try:
            raw_start_values(reported_fields(command), stated)
        except ValueError as error:
            message = f"start_values of {stated.query}: {error}"
            yield Problem(stated.place, "bad-start-value", message)


RULES = (start_values_fit,)
