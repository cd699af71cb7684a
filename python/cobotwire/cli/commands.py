"""``cobotwire commands``: list the commands of an edition, or describe one."""

from __future__ import annotations

import json
from inspect import getdoc

import click
from rich.table import Table as Grid

from cobotwire import editions
from cobotwire.cli.shared.completers import complete_commands
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.output import plain_console, print_grid
from cobotwire.inspect.calls import motions
from cobotwire.protocol.frame_format import FixedPart
from cobotwire.protocol.json_values import as_json_value
from cobotwire.protocol.table import Command, Direction, Field, FrameFormat, Number, Variant

_DIRECTIONS: tuple[Direction, ...] = ("request", "reply")
_NAMES = {"address": "address", "length": "LEN", "command": "CMD"}


@click.command()
@click.argument("name", required=False, shell_complete=complete_commands)
@click.option("--json", "as_json", is_flag=True, help="Print the commands as JSON.")
@uses_edition
def commands(edition: str, name: str | None, as_json: bool) -> None:
    """List the commands of the edition, or describe the command NAME byte by byte."""
    package = editions.load(edition)
    table = package.TABLE
    if name is not None and not as_json and (motion := motions(package).get(name)):
        text = getdoc(motion) or ""
        click.echo(f"`cobotwire call URL {name}` runs it; it is a method of the client.\n\n{text}")
        return
    chosen = table.commands if name is None else (table.command(name),)
    if as_json:
        click.echo(json.dumps([as_json_value(command) for command in chosen], indent=1))
    elif name is None:
        _print_list(chosen)
    else:
        _print_reference(table.frame, chosen[0])


def _print_list(chosen: tuple[Command, ...]) -> None:
    grid = Grid("id", "command", "safety", "what it does", box=None, pad_edge=False)
    for command in chosen:
        grid.add_row(f"0x{command.id:02X}", command.name, command.safety, command.title)
    print_grid(grid)


def _print_reference(frame: FrameFormat, command: Command) -> None:
    console = plain_console()
    console.print(f"{command.name}  0x{command.id:02X}  {command.safety}", style="bold")
    console.print(f"{command.title}. {command.doc}")
    for note in command.notes:
        console.print(f"Note: {note}")
    for direction in _DIRECTIONS:
        every = command.variants(direction)
        for index, variant in enumerate(every):
            # The smallest and the largest list suffice; the sizes between them look alike.
            if 0 < index < len(every) - 1 and any(field.sizes for field in variant.fields):
                continue
            console.print(f"\n{direction}", style="bold")
            print_grid(byte_table(frame, command, direction, variant))
    if command.text is not None:
        pairs = zip(command.text.prefixes, command.text.fields)
        console.print("\nreply, as text without a frame", style="bold")
        console.print("".join(f"{prefix}<{field}>" for prefix, field in pairs))
    elif not command.reply:
        console.print("\nreply: none")


def byte_table(
    frame: FrameFormat, command: Command, direction: Direction, variant: Variant
) -> Grid:
    """Return a table of the bytes of one variant of a message."""
    grid = Grid("byte", "content", "value", "meaning", box=None, pad_edge=False)
    grid.add_row(_place(0, len(frame.header)), "header", frame.header.hex(" ").upper(), "")
    start = frame.start(command.id, frame.length(variant.size, direction), direction=direction)
    for part in frame.layout:
        at, width = _fixed_part(frame, part, direction)
        value = start[at : at + width].hex(" ").upper()
        if part == "address":
            value = ", ".join(f"{a:02X}" for a in frame.addresses)
        if width:
            grid.add_row(_place(at, width), _NAMES[part], value, "")
    offset = len(start)
    for field in variant.fields:
        for index, number in enumerate(field.cases[0].numbers):
            place = _place(offset, number.width)
            name = f"{field.name} {number.name}".strip()
            ranges = [_allowed(field, case.numbers[index]) for case in field.cases]
            grid.add_row(place, name, " or ".join(ranges), field.doc)
            offset += number.step
    if frame.check is not None:
        grid.add_row(_place(offset, frame.check.width), frame.check.algorithm, "", "")
        offset += frame.check.width
    if frame.footer:
        place = _place(offset, len(frame.footer))
        grid.add_row(place, "footer", frame.footer.hex(" ").upper(), "")
    return grid


def _place(at: int, width: int) -> str:
    return str(at) if width == 1 else f"{at}-{at + width - 1}"


def _fixed_part(frame: FrameFormat, part: FixedPart, direction: Direction) -> tuple[int, int]:
    """Return the offset and the size of a part; its size is 0 if frames do not have it."""
    if part == "address":
        return frame.address_at or 0, 1 if frame.addresses else 0
    if part == "length":
        return frame.length_at, frame.length_number.width
    return frame.id_at, frame.id_number.width if frame.has_id(direction) else 0


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
