"""``cobotwire ports``: list the serial ports that an arm may be connected to."""

from __future__ import annotations

import json
import sys

import click

from cobotwire.protocol.printable import printable
from cobotwire.transport.serial import ports as serial_ports
from cobotwire.transport.serial.ports import Port

NOT_ALLOWED = (
    "you have no permission to open it; on most systems: sudo usermod -aG dialout $USER, "
    "then log in again"
)


@click.command(short_help="List serial ports, likely ones first.")
@click.option("--json", "as_json", is_flag=True, help="Print the ports as JSON.")
def ports(as_json: bool) -> None:
    """List the serial ports that may lead to an arm, likely ones first, with the reason.

    No port is opened. Exit codes: 0 there is a likely port; 1 there is none.
    """
    found = serial_ports.ports()
    if as_json:
        click.echo(json.dumps([port._asdict() for port in found], indent=1))
    elif not found:
        click.echo(
            "no serial port was found; check that the arm's cable is plugged in and its power is on"
        )
    for port in () if as_json else found:
        click.echo("\n".join(_lines(port)))
    sys.exit(0 if any(port.likely for port in found) else 1)


def _lines(port: Port) -> list[str]:
    verdict = "likely  " if port.likely else "unlikely"
    usb = f" ({port.usb})" if port.usb else ""
    lines = [f"{printable(port.device):<16} {verdict}  {port.why}{usb}"]
    number = f", serial number {printable(port.serial_number)}" if port.serial_number else ""
    if port.description or number:
        lines.append(f"{'':<16} {'':8}  {printable(port.description)}{number}")
    if not port.accessible:
        lines.append(f"{'':<16} {'':8}  {NOT_ALLOWED}")
    return lines
