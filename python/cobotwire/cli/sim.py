"""``cobotwire sim``: a simulated arm to talk to."""

from __future__ import annotations

import os
import signal
import sys
from types import FrameType

import click

from cobotwire import editions
from cobotwire.codec.interface import Noise
from cobotwire.explain import summary
from cobotwire.session.device import Asked, DeviceEvent, Malformed, Told
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
        # Should the end hang, on a full pipe behind our output for one, the next signal ends it.
        signal.signal(number, signal.SIG_DFL)

    signal.signal(signal.SIGINT, stop)
    signal.signal(signal.SIGTERM, stop)
    _say(server.url)
    if sys.stdout.isatty():
        click.echo(f"Try: cobotwire call get_angles --port {server.url}   (Ctrl-C ends)", err=True)
    try:
        server.serve()
    finally:
        server.close()


def _show(event: DeviceEvent, answer: bytes) -> None:
    said = f"   answered {answer.hex(' ').upper()}" if answer else ""
    if isinstance(event, Noise):
        _say(f"noise   {event.data.hex(' ').upper()}   {event.reason}")
    elif isinstance(event, Asked):
        _say(f"heard   {event.frame.data.hex(' ').upper()}   {summary(event.message)}{said}")
    elif isinstance(event, Malformed):
        _say(f"refused {event.frame.data.hex(' ').upper()}   {event.error}")
    elif isinstance(event, Told):
        fields = ", ".join(f"{name}={value!r}" for name, value in event.fields.items())
        _say(f"text    of {event.command.name}: {fields}")


def _say(line: str) -> None:
    try:
        click.echo(line)
    except BrokenPipeError:
        # Whoever read our output (head -1, say) has had enough; the arm goes on serving. The
        # descriptor is replaced, so that nothing printed later, nor the flush at exit, fails.
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)
