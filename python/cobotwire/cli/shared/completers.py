"""Complete the words of the command line: commands, editions, fault scenarios and ports."""

from __future__ import annotations

from collections.abc import Iterable

import click
from click.shell_completion import CompletionItem

from cobotwire import editions
from cobotwire.protocol.errors import CobotwireError


def complete_editions(
    context: click.Context, parameter: click.Parameter, start: str
) -> list[CompletionItem]:
    """Return the matching editions of cobotwire; if no edition matches, folders."""
    return _items(editions.names(), start) or [CompletionItem(start, type="dir")]


def complete_commands(
    context: click.Context, parameter: click.Parameter, start: str
) -> list[CompletionItem]:
    """Return the commands of the edition, with their titles; for ``call`` also the motions."""
    try:
        edition = editions.load(context.obj or editions.DEFAULT)
    except CobotwireError:
        return []
    commands = (command for command in edition.TABLE.commands if command.name.startswith(start))
    found = [CompletionItem(command.name, help=command.title) for command in commands]
    if context.info_name == "call":
        from cobotwire.inspect.calls import motions

        found += _items(motions(edition), start)
    return found


def complete_scenarios(
    context: click.Context, parameter: click.Parameter, start: str
) -> list[CompletionItem]:
    """Return the matching fault scenarios of cobotwire; if no scenario matches, files."""
    from cobotwire.simulator.faults import shipped

    return _items(shipped(), start) or [CompletionItem(start, type="file")]


def complete_ports(
    context: click.Context, parameter: click.Parameter, start: str
) -> list[CompletionItem]:
    """Return the matching serial ports, likely ones first; if no port matches, files."""
    from cobotwire.transport.serial.ports import ports

    return _items((port.device for port in ports()), start) or [CompletionItem(start, type="file")]


def _items(words: Iterable[str], start: str) -> list[CompletionItem]:
    return [CompletionItem(word) for word in words if word.startswith(start)]
