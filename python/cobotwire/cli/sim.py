"""``cobotwire sim``: a simulated arm to talk to."""

from __future__ import annotations

import click

from cobotwire import editions
from cobotwire.cli.faults import list_scenarios, with_faults
from cobotwire.cli.serving import say, serve
from cobotwire.codec.interface import Noise
from cobotwire.explain import summary
from cobotwire.session.device import Asked, DeviceEvent, Malformed, Told
from cobotwire.sim import PtyPort, SimulatedArm


@click.command()
@click.option("--quiet", is_flag=True, help="Print the port, but not what goes over the line.")
@click.option("--scenario", help="A fault scenario: a YAML file, or a name of --list-scenarios.")
@click.option("--seed", type=int, help="With --scenario: other draws than the file's.")
@click.option(
    "--list-scenarios",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=list_scenarios,
    help="Print the scenarios that come with the package.",
)
@click.pass_obj
def sim(edition: str, quiet: bool, scenario: str | None, seed: int | None) -> None:
    """Serve a simulated arm on a pseudo-terminal until Ctrl-C.

    The first line is the port to open; then a line for everything that is heard and answered,
    and for every fault that is done.
    """
    arm = SimulatedArm(editions.load(edition).TABLE, watch=None if quiet else _show)
    serve(PtyPort(with_faults(arm, scenario, seed, quiet=quiet)))


def _show(event: DeviceEvent, answer: bytes) -> None:
    said = f"   answered {answer.hex(' ').upper()}" if answer else ""
    if isinstance(event, Noise):
        say(f"noise   {event.data.hex(' ').upper()}   {event.reason}")
    elif isinstance(event, Asked):
        say(f"heard   {event.frame.data.hex(' ').upper()}   {summary(event.message)}{said}")
    elif isinstance(event, Malformed):
        say(f"refused {event.frame.data.hex(' ').upper()}   {event.error}")
    elif isinstance(event, Told):
        fields = ", ".join(f"{name}={value!r}" for name, value in event.fields.items())
        say(f"text    of {event.command.name}: {fields}")
