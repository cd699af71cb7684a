"""``cobotwire sim``: a simulated arm to talk to."""

from __future__ import annotations

import itertools
import json
import sys
from collections.abc import Callable
from contextlib import ExitStack

import click

from cobotwire import editions
from cobotwire.cli.heard import in_json, in_line
from cobotwire.cli.joints import JointTable
from cobotwire.cli.serving import say, serve
from cobotwire.errors import UsageError
from cobotwire.session.device import DeviceEvent
from cobotwire.sim import PtyPort, RunningClock, Server, SimulatedArm, TcpPort
from cobotwire.sim.peer import Peer
from cobotwire.sim.tcp import address

FASTEST = 1e6
# Shows an event and its answer; the number says whose it is, where there may be several clients.
Show = Callable[[int | None, DeviceEvent, bytes], str]


@click.command()
@click.option("--pty", "on_pty", is_flag=True, help="Serve a pseudo-terminal [default].")
@click.option("--tcp", metavar="HOST:PORT", help="Serve TCP; :0 is any free port on loopback.")
@click.option("--speed", type=float, default=1.0, help="The arm's time: 2 runs twice as fast.")
@click.option("--quiet", is_flag=True, help="Print the port, but not what goes over the line.")
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object a line.")
@click.pass_obj
def sim(
    edition: str, on_pty: bool, tcp: str | None, speed: float, quiet: bool, as_json: bool
) -> None:
    """Serve a simulated arm on a pseudo-terminal, or over TCP, until Ctrl-C.

    The first line is the port to open; then a line for everything that is heard and answered, and
    on a terminal a table of the joints. Over TCP several clients see the same arm; each line says
    whose it is.
    """
    if on_pty and tcp is not None:
        raise UsageError("--tcp", tcp, "one of --pty and --tcp")
    if not 0 < speed <= FASTEST:
        raise UsageError("speed", speed, f"above 0, up to {FASTEST:g}")
    package = editions.load(edition)
    clock = RunningClock(speed)
    arm = SimulatedArm(package.TABLE, clock=clock)
    show = None if quiet else (in_json if as_json else in_line)
    server = _server(arm, clock, tcp, show)
    with ExitStack() as stack:
        look = None
        if sys.stdout.isatty() and not (quiet or as_json):
            look = stack.enter_context(JointTable(package, arm, clock)).look
        serve(
            server, json.dumps({"event": "serving", "url": server.url}) if as_json else None, look
        )


def _server(arm: SimulatedArm, clock: RunningClock, tcp: str | None, show: Show | None) -> Server:
    if tcp is None:
        return PtyPort(_line(arm, None, show), clock)
    numbers = itertools.count(1)
    host, port = address(tcp)
    server = TcpPort(lambda: _line(arm, next(numbers), show), host, port, clock)
    if not server.loopback:
        click.echo(f"cobotwire: whoever can reach {host} moves this arm unasked", err=True)
    return server


def _line(arm: SimulatedArm, client: int | None, show: Show | None) -> Peer:
    """What answers one client."""
    if show is None:
        return arm.another_line()
    return arm.another_line(lambda event, answer: say(show(client, event, answer)))
