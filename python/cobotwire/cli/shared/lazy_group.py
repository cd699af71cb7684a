"""A group of verbs that imports a verb when it is used."""

from __future__ import annotations

from importlib import import_module

import click

from cobotwire.cli.shared.edition_option import note_unused
from cobotwire.protocol.errors import did_you_mean


class LazyGroup(click.Group):
    """A group of verbs with their summaries, so that ``--help`` and one verb import no other verb.

    The verb NAME is the function NAME in the module MODULES + NAME.
    """

    # Each verb with its text in --help, in the order of --help.
    verbs: dict[str, str]
    modules: str

    def list_commands(self, context: click.Context) -> list[str]:
        """Return the names of the verbs."""
        return list(self.verbs)

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        """Import a verb; return None if there is none of that name."""
        if name not in self.verbs:
            return None
        verb = getattr(import_module(self.modules + name), name)
        assert isinstance(verb, click.Command), f"{name} is a verb"
        # For completion.
        verb.short_help = self.verbs[name]
        return verb

    def resolve_command(
        self, context: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the verb that the first word names, and the words after it."""
        word = args[0]
        if word not in self.verbs and not (word.startswith("-") or context.resilient_parsing):
            hint = did_you_mean(word, self.list_commands(context))
            context.fail(f"there is no command {word!r}{hint}")
        name, verb, rest = super().resolve_command(context, args)
        if verb is not None and not context.resilient_parsing:
            note_unused(context, verb)
        return name, verb, rest

    def format_commands(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of the verbs."""
        with formatter.section("Commands"):
            formatter.write_dl([(verb, self.verbs[verb]) for verb in self.list_commands(context)])
