"""What ``cobotwire sim`` says and does about faults."""

from __future__ import annotations

import click

from cobotwire import codec as codecs
from cobotwire.cli.serving import say
from cobotwire.errors import UsageError
from cobotwire.sim import SimulatedArm
from cobotwire.sim.faults import Done, find, shipped
from cobotwire.sim.peer import Peer


def with_faults(arm: SimulatedArm, scenario: str | None, seed: int | None, *, quiet: bool) -> Peer:
    """The arm, behind the faults of a scenario where one is named; each fault is told."""
    if scenario is None:
        if seed is not None:
            raise UsageError("seed", seed, "nothing without --scenario")
        return arm
    watch = None if quiet else _show
    return find(scenario, arm.table).wrap(arm, codecs.load(arm.table), seed=seed, watch=watch)


def list_scenarios(context: click.Context, option: click.Parameter, wanted: bool) -> None:
    """Print the scenarios that come with the package, and end."""
    if not wanted or context.resilient_parsing:
        return
    known = shipped()
    width = max(map(len, known))
    for name in known:
        click.echo(f"{name:<{width}}  {find(name).about}")
    context.exit()


def _show(done: Done) -> None:
    say(f"fault   {done}")
