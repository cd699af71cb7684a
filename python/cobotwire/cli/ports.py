"""``cobotwire ports``: where an arm may be."""

from __future__ import annotations

import json
import sys

import click

from cobotwire.transport.serial.ports import Port, ports

NOT_ALLOWED = (
    "you may not open it; on most systems: sudo usermod -aG dialout $USER, then log in anew"
)


@click.command(name="ports")
@click.option("--json", "as_json", is_flag=True, help="Print as JSON.")
def ports_(as_json: bool) -> None:
    """List the serial ports, those behind which an arm may stand first, and why.

    None of them is opened. Exit code 1 if there is no likely one.
    """
    found = ports()
    if as_json:
        click.echo(json.dumps([port._asdict() for port in found], indent=1))
    elif not found:
        click.echo("no serial port; is the arm's cable plugged in, and its power on?")
    for port in () if as_json else found:
        click.echo("\n".join(_lines(port)))
    sys.exit(0 if any(port.likely for port in found) else 1)


def _lines(port: Port) -> list[str]:
    verdict = "likely  " if port.likely else "unlikely"
    usb = f" ({port.usb})" if port.usb else ""
    lines = [f"{port.device:<16} {verdict}  {port.why}{usb}"]
    number = f", serial number {port.serial_number}" if port.serial_number else ""
    if port.description or number:
        lines.append(f"{'':<16} {'':8}  {port.description}{number}")
    if not port.accessible:
        lines.append(f"{'':<16} {'':8}  {NOT_ALLOWED}")
    return lines
