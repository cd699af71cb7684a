"""``cobotwire commands``: the list, or one command's reference."""

from __future__ import annotations

import json
from dataclasses import asdict

import click
from rich.console import Console
from rich.table import Table as Grid

from cobotwire import editions
from cobotwire.table import Command, Field, FrameFormat, Layout, Number


@click.command()
@click.argument("name", required=False)
@click.option("--json", "as_json", is_flag=True, help="Print as JSON.")
@click.pass_obj
def commands(edition: str, name: str | None, as_json: bool) -> None:
    """List the commands of the edition, or tell all about the command NAME."""
    table = editions.load(edition).TABLE
    chosen = table.commands if name is None else (table.command(name),)
    if as_json:
        click.echo(json.dumps([asdict(command) for command in chosen], indent=1))
    elif name is None:
        _list(chosen)
    else:
        _reference(table.frame, chosen[0])


def _list(chosen: tuple[Command, ...]) -> None:
    grid = Grid("id", "command", "safety", "what it does", box=None, pad_edge=False)
    for command in chosen:
        grid.add_row(f"0x{command.id:02X}", command.name, command.safety, command.title)
    _console().print(grid)


def _console() -> Console:
    # What the spec says is shown as it stands: a [word] or :word: in it is no markup of rich's.
    console = Console(highlight=False, markup=False, emoji=False)
    if not console.is_terminal:
        # No colour then, and lines as long as they come, for grep and the like.
        console.width = 200
    return console


def _reference(frame: FrameFormat, command: Command) -> None:
    console = _console()
    console.print(f"{command.name}  0x{command.id:02X}  {command.safety}", style="bold")
    console.print(f"{command.title}. {command.doc}")
    for note in command.notes:
        console.print(f"Note: {note}")
    for direction in ("request", "reply"):
        for form in command.layouts("request" if direction == "request" else "reply"):
            console.print(f"\n{direction}", style="bold")
            console.print(_layout(frame, command, form))
    if command.text is not None:
        pairs = zip(command.text.prefixes, command.text.fields)
        console.print("\nreply, outside any frame", style="bold")
        console.print("".join(f"{prefix}<{field}>" for prefix, field in pairs))
    elif not command.reply:
        console.print("\nreply: none")


def _layout(frame: FrameFormat, command: Command, form: Layout) -> Grid:
    grid = Grid("byte", "content", "value", "what it is", box=None, pad_edge=False)
    start = len(frame.header)
    grid.add_row(f"0-{start - 1}", "header", frame.header.hex(" ").upper(), "")
    grid.add_row(str(start), "LEN", f"{frame.length(form.size):02X}", "")
    grid.add_row(str(start + 1), "CMD", f"{command.id:02X}", "")
    offset = start + 2
    for field in form.fields:
        for index, number in enumerate(field.cases[0].numbers):
            last = offset + number.width - 1
            place = str(offset) if last == offset else f"{offset}-{last}"
            name = f"{field.name} {number.name}".strip()
            spans = [_span(field, case.numbers[index]) for case in field.cases]
            grid.add_row(place, name, " or ".join(spans), field.doc)
            offset = last + 1
    grid.add_row(str(offset), "footer", frame.footer.hex().upper(), "")
    return grid


def _span(field: Field, number: Number) -> str:
    if field.kind == "flag":
        return "0 no, 1 yes"
    if field.labels:
        return ", ".join(f"{c} {label}" for c, label in zip(field.choices, field.labels))
    low = number.minimum * number.multiply / number.divide
    high = number.maximum * number.multiply / number.divide
    step = f" (x {number.divide / number.multiply:g})" if number.scaled else ""
    return f"{low:g}..{high:g} {number.unit}".strip() + step
