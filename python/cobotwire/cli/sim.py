"""``cobotwire sim``: a simulated arm to talk to."""

from __future__ import annotations

import signal
import sys
from types import FrameType

import click

from cobotwire import editions
from cobotwire.codec.interface import Noise
from cobotwire.explain import summary
from cobotwire.session.device import Asked, DeviceEvent, Malformed
from cobotwire.sim import PtyServer, SimulatedArm


@click.command()
@click.option("--quiet", is_flag=True, help="Print the port, but not what goes over the line.")
@click.pass_obj
def sim(edition: str, quiet: bool) -> None:
    """Serve a simulated arm on a pseudo-terminal until Ctrl-C.

    The first line is the port to open; then a line for everything that is heard and answered.
    """
    arm = SimulatedArm(editions.load(edition).TABLE, watch=None if quiet else _show)
    server = PtyServer(arm)

    def stop(number: int, frame: FrameType | None) -> None:
        server.stop()

    signal.signal(signal.SIGINT, stop)
    signal.signal(signal.SIGTERM, stop)
    click.echo(server.url)
    if sys.stdout.isatty():
        click.echo(f"Try: cobotwire call get_angles --port {server.url}   (Ctrl-C ends)", err=True)
    try:
        server.serve()
    finally:
        server.close()


def _show(event: DeviceEvent, answer: bytes) -> None:
    if isinstance(event, Noise):
        click.echo(f"noise   {event.data.hex(' ').upper()}   {event.reason}")
        return
    said = f"   answered {answer.hex(' ').upper()}" if answer else ""
    if isinstance(event, Asked):
        click.echo(f"heard   {event.frame.data.hex(' ').upper()}   {summary(event.message)}{said}")
    elif isinstance(event, Malformed):
        click.echo(f"refused {event.frame.data.hex(' ').upper()}   {event.error}")
