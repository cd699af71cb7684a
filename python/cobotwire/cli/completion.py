"""``cobotwire completion``: print the script that completes words in a shell."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class

# click reads this variable; its name comes from the name of the program.
VARIABLE = "_COBOTWIRE_COMPLETE"
SHELLS = ("bash", "zsh", "fish")


@click.command()
@click.argument("shell", type=click.Choice(SHELLS))
@click.pass_context
def completion(context: click.Context, shell: str) -> None:
    """Print the script that completes the words of cobotwire in SHELL.

    It completes subcommands, commands, editions, fault scenarios and ports.

    Load it in the start file of the shell:

    \b
      eval "$(cobotwire completion bash)"        # ~/.bashrc, bash 4.4 or newer
      eval "$(cobotwire completion zsh)"         # ~/.zshrc, after compinit
      cobotwire completion fish | source         # ~/.config/fish/config.fish
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    kind = get_completion_class(shell)
    assert kind is not None, "click supports these shells"
    script = kind(context.find_root().command, {}, "cobotwire", VARIABLE)
    click.echo(script.source_template % script.source_vars())
