"""A group of subcommands that imports a subcommand when it is used."""

from __future__ import annotations

from importlib import import_module

import click

from cobotwire.cli.shared.edition_option import note_unused
from cobotwire.protocol.errors import did_you_mean


class LazyGroup(click.Group):
    """A group that imports only the subcommand that runs; ``--help`` imports none.

    The subcommand NAME is the function NAME in the module MODULES + NAME.
    """

    # Each subcommand with its text in --help, in the order of --help.
    subcommands: dict[str, str]
    modules: str

    def list_commands(self, context: click.Context) -> list[str]:
        """Return the names of the subcommands."""
        return list(self.subcommands)

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        """Import a subcommand; return None if no subcommand has that name."""
        if name not in self.subcommands:
            return None
        subcommand = getattr(import_module(self.modules + name), name)
        assert isinstance(subcommand, click.Command), f"{name} is a subcommand"
        # For completion.
        subcommand.short_help = self.subcommands[name]
        return subcommand

    def resolve_command(
        self, context: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the subcommand that the first word names, and the words after it."""
        word = args[0]
        if word not in self.subcommands and not (word.startswith("-") or context.resilient_parsing):
            hint = did_you_mean(word, self.list_commands(context))
            context.fail(f"there is no subcommand {word!r}{hint}")
        name, subcommand, rest = super().resolve_command(context, args)
        if subcommand is not None and not context.resilient_parsing:
            note_unused(context, subcommand)
        return name, subcommand, rest

    def format_commands(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of the subcommands."""
        with formatter.section("Commands"):
            formatter.write_dl(
                [
                    (subcommand, self.subcommands[subcommand])
                    for subcommand in self.list_commands(context)
                ]
            )
