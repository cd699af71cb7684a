"""``cobotwire studio``: show an arm and its traffic, or a recording, in the browser."""

from __future__ import annotations

from contextlib import ExitStack

import click

from cobotwire.cli.shared.arm_options import address_option, arm_options, parse_address
from cobotwire.cli.shared.completers import complete_ports
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.geometry_options import geometry_options
from cobotwire.cli.shared.motion_options import MotionOptions, motion_options
from cobotwire.cli.shared.output import print_line, report_written
from cobotwire.studio.extras import check_extra


@click.command()
@click.argument("source", required=False, metavar="[URL|RECORDING]", shell_complete=complete_ports)
@arm_options
@address_option
@click.option(
    "--rate", type=float, default=10.0, show_default=True, help="Polls a second; 0: only listen."
)
@click.option("--host", default="127.0.0.1", show_default=True, help="The address to listen on.")
@click.option(
    "--http-port",
    "port",
    type=click.IntRange(0, 65535),
    default=0,
    help="The TCP port of the page [default: a free one].",
)
@motion_options(silence=0.5)
@geometry_options
@click.option("--no-browser", is_flag=True, help="Print the address, but open no browser.")
@uses_edition
def studio(
    edition: str,
    source: str | None,
    baudrate: int | None,
    record: str | None,
    address: str | None,
    rate: float,
    host: str,
    port: int,
    motion: MotionOptions,
    geometry: str | None,
    tip: str | None,
    no_browser: bool,
) -> None:
    """Show the arm at URL, or a RECORDING, on a page in the browser, until Ctrl-C.

    URL is a serial port, or a URL such as socket://host:9000. Without it, a simulated arm is
    started, which the page may move. follow:RECORDING shows live what another program, such as
    cobotwire tap, records. The page shows the arm in 3D, charts of its values, and every frame,
    byte by byte; sliders and buttons move the arm.

    The first line of output is the address of the page. It contains a secret: whoever has it can
    see the page. Only programs on this machine reach the page, unless --host says otherwise.

    Only queries are sent to a real arm. Anything else needs --allow-motion here and the switch
    "Allow motion" on the page. With --allow-motion the arm is sent stop at the end.
    """
    check_extra()
    # Imported here: the packages of the extra may be absent.
    from cobotwire.studio.access import Access
    from cobotwire.studio.serving import Options, serve

    def announce(access: Access) -> None:
        if not access.loopback:
            click.echo(
                f"cobotwire: everyone who can read the network of {host} can read the secret "
                "of the address",
                err=True,
            )
        print_line(access.url)
        if record is not None:
            at_end.callback(report_written, record)

    options = Options(
        source,
        edition,
        baudrate,
        record,
        None if address is None else parse_address(address),
        rate,
        host,
        port,
        motion.allowed,
        not no_browser,
        motion.limits,
        motion.silence,
        geometry,
        tip,
    )
    with ExitStack() as at_end:
        serve(options, announce)
