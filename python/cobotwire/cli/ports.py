"""``cobotwire ports``: list the serial ports that an arm may be connected to."""

from __future__ import annotations

import errno
import json
import sys
from textwrap import fill

import click

from cobotwire.cli.shared.output import fold
from cobotwire.protocol.printable import printable
from cobotwire.transport.serial import ports as serial_ports
from cobotwire.transport.serial import remedies
from cobotwire.transport.serial.ports import Port
from cobotwire.transport.serial.remedies import Remedy

NOT_FOUND = (
    "no arm was found: `cobotwire ports --fix` says what to check; `cobotwire sim` simulates one"
)
NOT_ALLOWED = "you have no permission to open it"


@click.command()
@click.option("--fix", is_flag=True, help="Print what to do so that ports can be opened.")
@click.option("--json", "as_json", is_flag=True, help="Print the ports, or the steps, as JSON.")
def ports(fix: bool, as_json: bool) -> None:
    """List the serial ports that may lead to an arm, likely ones first, with the reason.

    With --fix, print what to do on this system so that the ports can be opened: permissions, names,
    drivers, and the programs that have them open. Nothing is changed.

    No port is opened. Exit codes: 0 there is a likely port; 1 there is none.
    """
    found, computer = serial_ports.ports(), serial_ports.this_computer()
    using = [(port.device, serial_ports.programs_using(port.device)) for port in found if fix]
    steps = remedies.remedies(computer, [each for each in using if each[1]])
    is_found = any(port.likely for port in found)
    if not is_found and not any(by for _, by in using):
        steps.insert(0, remedies.CABLE)
    if as_json:
        listed = [each._asdict() for each in (steps if fix else found)]
        shown = {"system": computer.system, "remedies": listed} if fix else listed
        lines = [json.dumps(shown, indent=1)]
    elif fix:
        lines = [line for step in steps for line in _step_lines(step)]
    else:
        lines = [line for port in found for line in _lines(port)] or [remedies.missing(computer)]
    text = "\n".join(lines)
    # Commands are not wrapped, so that they can be copied.
    click.echo(text if fix or as_json else fold(text))
    if not (is_found or fix or as_json):
        click.echo(fold(NOT_FOUND, err=True), err=True)
    sys.exit(0 if is_found else 1)


def _step_lines(step: Remedy) -> list[str]:
    text = fill(step.text, 79, initial_indent=f"{step.state:<9} ", subsequent_indent=" " * 10)
    return [text, *(["", *step.commands, ""] if step.commands else [])]


def _lines(port: Port) -> list[str]:
    verdict = "likely  " if port.likely else "unlikely"
    usb = f" ({port.usb})" if port.usb else ""
    lines = [f"{printable(port.device):<16} {verdict}  {port.why}{usb}"]
    number = f", serial number {printable(port.serial_number)}" if port.serial_number else ""
    if port.description or number:
        lines.append(f"{'':<16} {'':8}  {printable(port.description)}{number}")
    if not port.accessible:
        here = serial_ports.this_computer(port.device)
        why = remedies.explain(here, port.device, errno.EACCES, NOT_ALLOWED)
        lines.append(f"{'':<16} {'':8}  {why}")
    return lines
