"""``cobotwire commands``: list the commands of an edition, or describe one."""

from __future__ import annotations

import json
from dataclasses import asdict

import click
from rich.table import Table as Grid

from cobotwire import editions
from cobotwire.cli.shared.completers import complete_commands
from cobotwire.cli.shared.output import plain_console
from cobotwire.protocol.table import Command, Field, FrameFormat, Number, Variant


@click.command(short_help="List the commands, or describe one.")
@click.argument("name", required=False, shell_complete=complete_commands)
@click.option("--json", "as_json", is_flag=True, help="Print the commands as JSON.")
@click.pass_obj
def commands(edition: str, name: str | None, as_json: bool) -> None:
    """List the commands of the edition, or describe the command NAME byte by byte."""
    table = editions.load(edition).TABLE
    chosen = table.commands if name is None else (table.command(name),)
    if as_json:
        click.echo(json.dumps([asdict(command) for command in chosen], indent=1))
    elif name is None:
        _print_list(chosen)
    else:
        _print_reference(table.frame, chosen[0])


def _print_list(chosen: tuple[Command, ...]) -> None:
    grid = Grid("id", "command", "safety", "what it does", box=None, pad_edge=False)
    for command in chosen:
        grid.add_row(f"0x{command.id:02X}", command.name, command.safety, command.title)
    plain_console().print(grid)


def _print_reference(frame: FrameFormat, command: Command) -> None:
    console = plain_console()
    console.print(f"{command.name}  0x{command.id:02X}  {command.safety}", style="bold")
    console.print(f"{command.title}. {command.doc}")
    for note in command.notes:
        console.print(f"Note: {note}")
    for direction, variants in (("request", command.request), ("reply", command.reply)):
        for variant in variants:
            console.print(f"\n{direction}", style="bold")
            console.print(byte_table(frame, command, variant))
    if command.text is not None:
        pairs = zip(command.text.prefixes, command.text.fields)
        console.print("\nreply, as text without a frame", style="bold")
        console.print("".join(f"{prefix}<{field}>" for prefix, field in pairs))
    elif not command.reply:
        console.print("\nreply: none")


def byte_table(frame: FrameFormat, command: Command, variant: Variant) -> Grid:
    """Return a table of the bytes of one variant of a message."""
    grid = Grid("byte", "content", "value", "meaning", box=None, pad_edge=False)
    start = len(frame.header)
    grid.add_row(f"0-{start - 1}", "header", frame.header.hex(" ").upper(), "")
    if frame.addresses:
        grid.add_row(str(start), "address", ", ".join(f"{a:02X}" for a in frame.addresses), "")
    grid.add_row(str(frame.length_at), "LEN", f"{frame.length(variant.size):02X}", "")
    grid.add_row(str(frame.length_at + 1), "CMD", f"{command.id:02X}", "")
    offset = frame.length_at + 2
    for field in variant.fields:
        for index, number in enumerate(field.cases[0].numbers):
            last = offset + number.width - 1
            place = str(offset) if last == offset else f"{offset}-{last}"
            name = f"{field.name} {number.name}".strip()
            ranges = [_allowed(field, case.numbers[index]) for case in field.cases]
            grid.add_row(place, name, " or ".join(ranges), field.doc)
            offset = last + 1
    last = offset + frame.check_size - 1
    place = str(offset) if last == offset else f"{offset}-{last}"
    grid.add_row(place, frame.check, frame.footer.hex(" ").upper(), "")
    return grid


def _allowed(field: Field, number: Number) -> str:
    if field.const is not None:
        return f"{field.physical([field.const])}, always"
    if field.kind == "flag":
        return "0 no, 1 yes"
    if field.labels:
        return ", ".join(f"{c} {label}" for c, label in zip(field.choices, field.labels))
    low, high = number.physical(number.minimum), number.physical(number.maximum)
    step = f" (x {number.divide / number.multiply:g})" if number.scaled else ""
    return f"{low:g}..{high:g} {number.units}".strip() + step
