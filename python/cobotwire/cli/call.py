"""``cobotwire call``: one command to an arm."""

from __future__ import annotations

import json
from enum import IntEnum
from typing import Any

import click

from cobotwire import editions
from cobotwire.cli.arguments import parse
from cobotwire.cli.link import link_options, linked


# A negative number looks like an option to click; as none is known by that name, it is passed on.
@click.command(context_settings={"ignore_unknown_options": True})
@click.argument("name")
@click.argument("values", nargs=-1, metavar="[ARGS]...")
@click.option("--port", required=True, help="A serial port, or a URL such as socket://host:9000.")
@link_options
@click.option("--timeout", type=float, help="Seconds to wait [default: the command's].")
@click.option("--json", "as_json", is_flag=True, help="Print the answer as JSON.")
@click.pass_obj
def call(
    edition: str,
    name: str,
    values: tuple[str, ...],
    port: str,
    baudrate: int | None,
    record: str | None,
    timeout: float | None,
    as_json: bool,
) -> None:
    """Call one command: NAME with its ARGS in order, or as name=value.

    Lists are separated by commas; enum members go by name or number:

    \b
      cobotwire call get_angles --port /dev/ttyACM0
      cobotwire call send_angles 0,0,0,0,0,0 speed=30 --port /dev/ttyACM0
      cobotwire call set_reference_frame WORLD --port /dev/ttyACM0
    """  # noqa: D301  (\b is the control character by which click keeps the lines)
    package = editions.load(edition)
    command = package.TABLE.command(name)
    arguments = parse(command, values)
    with linked(port, package.TABLE, baudrate, record) as link:
        result = getattr(package.CLIENT(link, timeout=timeout), name)(**arguments)
    if as_json:
        click.echo(json.dumps({"command": name, "result": plain(result)}))
    elif result is not None:
        click.echo(in_words(result))


def plain(value: Any) -> Any:
    """A result as JSON knows it; named tuples become objects."""
    if hasattr(value, "_asdict"):
        return {name: plain(part) for name, part in value._asdict().items()}
    if isinstance(value, IntEnum):
        return value.name
    return list(value) if isinstance(value, tuple) else value


def in_words(value: Any) -> str:
    """A result for people, on one line."""
    if hasattr(value, "_asdict"):
        return "  ".join(f"{name}={part}" for name, part in value._asdict().items())
    return value.name if isinstance(value, IntEnum) else str(value)
