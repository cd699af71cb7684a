"""``cobotwire call``: send one command to an arm."""

from __future__ import annotations

import json

import click

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.cli.shared.arm_options import (
    address_option,
    arm_options,
    open_arm,
    parse_address,
)
from cobotwire.cli.shared.completers import complete_commands, complete_ports
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.output import format_result
from cobotwire.inspect.call_arguments import parse
from cobotwire.inspect.readiness import check_accepted, check_ready
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.json_values import as_json_value
from cobotwire.session.request import RequestEncoder


# click reads a negative number as an unknown option; unknown options are passed on as ARGS.
@click.command(
    short_help="Send one command; print the result.",
    context_settings={"ignore_unknown_options": True},
)
@click.argument("port", metavar="URL", shell_complete=complete_ports)
@click.argument("name", shell_complete=complete_commands)
@click.argument("args", nargs=-1, metavar="[ARGS]...")
@arm_options
@address_option
@click.option(
    "--timeout", type=float, help="Seconds to wait for the reply [default: the command's]."
)
@click.option(
    "--force", is_flag=True, help="Send a motion without asking whether the arm will obey it."
)
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
@uses_edition
def call(
    edition: str,
    port: str,
    name: str,
    args: tuple[str, ...],
    baudrate: int | None,
    record: str | None,
    address: str | None,
    timeout: float | None,
    force: bool,
    as_json: bool,
) -> None:
    """Send the command NAME with its ARGS to the arm at URL, and print the result.

    URL is a serial port, or a URL such as socket://host:9000.
    Write ARGS in the order of the command's arguments, or as name=value. Separate the items of a
    list by commas. Write an enum member as its name or its number:

    \b
      cobotwire call /dev/ttyACM0 get_angles
      cobotwire call /dev/ttyACM0 send_angles 0,0,0,0,0,0 speed=30
      cobotwire call /dev/ttyACM0 set_reference_frame WORLD

    `cobotwire commands NAME` shows the arguments of a command.

    Before a motion that has arguments, the arm is asked whether it has power, whether it is paused,
    and what its error register is. If it would not obey, the motion is not sent; --force sends it.
    After the motion the error register is read again, since the arm does not say that it rejects a
    motion.
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    package = editions.load(edition)
    to = None if address is None else parse_address(address)
    command = package.TABLE.command(name)
    if command.event:
        message = f"{name} is an event, which the device sends without a request"
        raise UsageError("command", name, message=message)
    arguments = parse(command, args)
    # A bad value is reported before the arm is asked whether it obeys.
    RequestEncoder(codecs.load(package.TABLE)).encode_request(command.request_type(**arguments))
    with (
        open_arm(port, package.TABLE, baudrate, record) as transport,
        # A query that fails must not stop a motion that an earlier call began.
        package.CLIENT(transport, timeout=timeout, on_error="leave", address=to) as arm,
    ):
        checks = command.starts_motion and not force
        if checks:
            check_ready(arm, command)
        result = getattr(arm, name)(**arguments)
        if checks:
            check_accepted(arm, command)
    if as_json:
        click.echo(json.dumps({"command": name, "result": as_json_value(result)}))
    elif result is not None:
        click.echo(format_result(result))
