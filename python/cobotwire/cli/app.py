"""The verbs together, and what they share."""

from __future__ import annotations

from typing import Any

import click

import cobotwire
from cobotwire.cli.call import call
from cobotwire.cli.commands import commands
from cobotwire.cli.conform import conform
from cobotwire.cli.decode import decode
from cobotwire.cli.demo import demo
from cobotwire.cli.doctor import doctor
from cobotwire.cli.failure import EPILOG, failures
from cobotwire.cli.monitor import monitor
from cobotwire.cli.plot import plot
from cobotwire.cli.ports import ports_
from cobotwire.cli.replay import replay
from cobotwire.cli.sim import sim
from cobotwire.editions import DEFAULT


class _App(click.Group):
    def invoke(self, ctx: click.Context) -> Any:
        """Run a verb; what goes wrong becomes a line and an exit code."""
        with failures():
            return super().invoke(ctx)


def _version(ctx: click.Context, parameter: click.Parameter, wanted: bool) -> None:
    if wanted and not ctx.resilient_parsing:
        with failures():
            click.echo(f"cobotwire {cobotwire.__version__}, {cobotwire.codec_in_use()} codec")
        ctx.exit()


@click.group(cls=_App, context_settings={"help_option_names": ["-h", "--help"]}, epilog=EPILOG)
@click.option(
    "--edition",
    default=DEFAULT,
    show_default=True,
    help="The edition of the protocol, or a package that cobotwire-gen build made.",
)
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_version,
    help="Show the version and the codec in use.",
)
@click.pass_context
def app(ctx: click.Context, edition: str) -> None:
    """Talk to a myCobot arm, simulate one, and read what goes over its line."""
    ctx.obj = edition


for verb in (demo, ports_, doctor, monitor, call, decode, sim, replay, plot, conform, commands):
    app.add_command(verb)
