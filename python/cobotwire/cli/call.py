"""``cobotwire call``: send one command to an arm."""

from __future__ import annotations

import json
import sys

import click

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
from cobotwire.inspect.calls import Done, prepare
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.json_values import as_json_value


# click reads a negative number as an unknown option; unknown options are passed on as ARGS.
@click.command(context_settings={"ignore_unknown_options": True})
@click.argument("port", metavar="URL", shell_complete=complete_ports)
@click.argument("name", required=False, shell_complete=complete_commands)
@click.argument("args", nargs=-1, metavar="[ARGS]...")
@arm_options
@address_option
@click.option(
    "--timeout", type=float, help="Seconds to wait for the reply [default: the command's]."
)
@click.option(
    "--force", is_flag=True, help="Send a motion without checking whether the arm will obey it."
)
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
@uses_edition
@click.pass_context
def call(
    context: click.Context,
    edition: str,
    port: str,
    name: str | None,
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
    list by commas or spaces. Write an enum member as its name or its number:

    \b
      cobotwire call /dev/ttyACM0 get_angles
      cobotwire call /dev/ttyACM0 send_angles 0,0,0,0,0,0 speed=30
      cobotwire call /dev/ttyACM0 set_reference_frame WORLD

    `cobotwire commands NAME` shows the arguments of a command.

    NAME can also be a motion of the client, such as go_home or move_angles: it waits until the arm
    has arrived, for at most timeout=SECONDS, and prints its position. Ctrl-C stops the arm:

    \b
      cobotwire call /dev/ttyACM0 go_home 30
      cobotwire call /dev/ttyACM0 move_angles 0,20,0,0,0,0 speed=30 timeout=20

    The result is printed to standard output. If there is none, a line on standard error says
    whether the arm acknowledged the request.

    Before a motion that has arguments, the arm's power, pause and error register are queried. If
    the arm would not obey, the motion is not sent, unless --force is given. After the motion the
    error register is read again, since no reply reports a rejected motion.
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    if name is None:
        message = (
            f"call takes the port, then a command: cobotwire call URL {port}; `cobotwire ports` "
            "lists ports, `cobotwire commands` the commands"
        )
        raise UsageError("name", message=message)
    package = editions.load(edition)
    to = None if address is None else parse_address(address)
    _reject_options(context, args)
    planned = prepare(package, name, args, to)
    with (
        open_arm(port, package.TABLE, baudrate, record) as transport,
        # Only a motion that is waited for is stopped: a query that fails must not stop a motion
        # that an earlier call began.
        package.CLIENT(transport, timeout=timeout, on_error=planned.on_error, address=to) as arm,
    ):
        try:
            done = planned.run(arm, port, force=force, timeout=timeout)
        except KeyboardInterrupt:
            if planned.on_error == "stop":
                # The terminal has echoed ^C on this line.
                start = "\n" if sys.stderr.isatty() else ""
                click.echo(f"{start}cobotwire: interrupted; stop is sent to the arm", err=True)
            raise
    if not isinstance(done, Done):
        raise done
    if as_json:
        shown = {"command": name, "result": as_json_value(done.result), **done.facts}
        click.echo(json.dumps(shown))
        return
    if done.result is not None:
        click.echo(format_result(done.result))
    if done.remark:
        # Not on standard output, where programs read the results.
        click.echo(done.remark, err=True)


def _reject_options(context: click.Context, words: tuple[str, ...]) -> None:
    """Reject a misspelt option, which would be taken for an argument of the command."""
    known = [name for option in context.command.params for name in option.opts]
    for word in words:
        name = word.partition("=")[0]
        if name.startswith("--"):
            hint = f"an argument is written as {word[2:].partition('=')[0]}=VALUE."
            raise click.NoSuchOption(name, f"No such option {name}; {hint}", known, context)
