"""``cobotwire mcp``: offer an arm to a language model."""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Literal

import click

from cobotwire import editions
from cobotwire.cli.shared.arm_options import address_option, arm_options, parse_address
from cobotwire.cli.shared.completers import complete_ports
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.motion_options import MotionOptions, motion_options
from cobotwire.protocol.addresses import check_one_moves
from cobotwire.protocol.errors import UsageError


@click.command()
@click.argument("port", metavar="URL", shell_complete=complete_ports)
@arm_options
@address_option
@motion_options(silence=60.0)
@click.option(
    "--tools",
    type=click.Choice(["basic", "all"]),
    default="basic",
    show_default=True,
    help="A dozen tools, or one for each command.",
)
@uses_edition
def mcp(
    edition: str,
    port: str,
    baudrate: int | None,
    record: str | None,
    address: str | None,
    motion: MotionOptions,
    tools: Literal["basic", "all"],
) -> None:
    """Offer the arm at URL to a language model, as tools of the Model Context Protocol.

    A client of MCP starts this program and talks to it by its standard input and output; it ends
    when the client closes them. URL is a serial port, or a URL such as socket://host:9000.

    By default only queries are sent. --allow-motion also offers tools that move and change the
    arm. stop is always offered. A motion is stopped if no message comes for --silence seconds, or
    when the client disconnects.
    """
    try:
        import_module("mcp.server")
    except ImportError as error:
        message = "cobotwire mcp needs mcp: pip install 'cobotwire[mcp]'"
        raise UsageError("mcp", message=message) from error
    # Imported here: the package of the extra may be absent.
    from cobotwire.adapters.mcp.server import Options, serve

    if sys.stdin.isatty():
        click.echo(
            "cobotwire: waiting for a client of MCP on standard input (docs/mcp.md)", err=True
        )
    to = None if address is None else parse_address(address)
    if motion.allowed:
        check_one_moves(editions.load(edition).TABLE, to)
    serve(Options(port, edition, baudrate, record, to, *motion, tools))
