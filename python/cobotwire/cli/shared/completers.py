"""Complete the words of the command line: commands, editions, fault scenarios and ports."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress

import click
from click.shell_completion import CompletionItem

from cobotwire import editions
from cobotwire.protocol.errors import CobotwireError


def complete_editions(
    context: click.Context, parameter: click.Parameter, start: str
) -> list[CompletionItem]:
    """Return the editions that come with cobotwire, or folders."""
    return _items(editions.names(), start) or [CompletionItem(start, type="dir")]


def complete_commands(
    context: click.Context, parameter: click.Parameter, start: str
) -> list[CompletionItem]:
    """Return the commands of the edition, with their titles."""
    try:
        table = editions.load(context.obj or editions.DEFAULT).TABLE
    except CobotwireError:
        return []
    commands = (command for command in table.commands if command.name.startswith(start))
    return [CompletionItem(command.name, help=command.title) for command in commands]


def complete_calls(
    context: click.Context, parameter: click.Parameter, start: str
) -> list[CompletionItem]:
    """Return the commands of the edition, and the motions of its client."""
    from cobotwire.inspect.calls import motions

    commands = complete_commands(context, parameter, start)
    with suppress(CobotwireError):
        commands += _items(motions(editions.load(context.obj or editions.DEFAULT)), start)
    return commands


def complete_scenarios(
    context: click.Context, parameter: click.Parameter, start: str
) -> list[CompletionItem]:
    """Return the fault scenarios that come with cobotwire, or files."""
    from cobotwire.simulator.faults import shipped

    return _items(shipped(), start) or [CompletionItem(start, type="file")]


def complete_ports(
    context: click.Context, parameter: click.Parameter, start: str
) -> list[CompletionItem]:
    """Return the serial ports of this computer, likely ones first, or files."""
    from cobotwire.transport.serial.ports import ports

    return _items((port.device for port in ports()), start) or [CompletionItem(start, type="file")]


def _items(words: Iterable[str], start: str) -> list[CompletionItem]:
    return [CompletionItem(word) for word in words if word.startswith(start)]
