"""What ``cobotwire sim`` does about faults."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

from cobotwire import codec as codecs
from cobotwire.errors import UsageError
from cobotwire.sim import RunningClock, SimulatedArm
from cobotwire.sim.faults import Done, Scenario, find, shipped
from cobotwire.sim.peer import Peer
from cobotwire.table import Table

Decorated = Callable[..., Any]


def scenario_options(verb: Decorated) -> Decorated:
    """The options by which faults are asked for."""
    for option in (
        click.option(
            "--list-scenarios",
            is_flag=True,
            is_eager=True,
            expose_value=False,
            callback=_list_scenarios,
            help="Print the scenarios that come with the package.",
        ),
        click.option("--seed", type=int, help="With --scenario: other draws than the file's."),
        click.option(
            "--scenario", help="A fault scenario: a YAML file, or a name of --list-scenarios."
        ),
    ):
        verb = option(verb)
    return verb


def chosen(scenario: str | None, seed: int | None, table: Table) -> Scenario | None:
    """The scenario that is named; None: all is well.

    Raises:
        UsageError: there is none of that name, or a seed without one.
        ScenarioError: the file is none.
    """
    if scenario is None and seed is not None:
        raise UsageError("seed", seed, "nothing without --scenario")
    return None if scenario is None else find(scenario, table)


def with_faults(
    arm: SimulatedArm,
    scenario: Scenario | None,
    seed: int | None,
    clock: RunningClock,
    watch: Callable[[Done], None],
) -> Peer:
    """The arm, behind the faults of a scenario where there is one; ``watch`` is told each fault."""
    if scenario is None:
        return arm
    return scenario.wrap(arm, codecs.load(arm.table), clock=clock, seed=seed, watch=watch)


def _list_scenarios(context: click.Context, option: click.Parameter, wanted: bool) -> None:
    """Print the scenarios that come with the package, and end."""
    if not wanted or context.resilient_parsing:
        return
    known = shipped()
    width = max(map(len, known))
    for name in known:
        click.echo(f"{name:<{width}}  {find(name).about}")
    context.exit()
