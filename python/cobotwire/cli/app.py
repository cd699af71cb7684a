"""Put the subcommands together; define the options that all of them share."""

from __future__ import annotations

from typing import Any

import click

import cobotwire
from cobotwire.cli.shared.edition_option import edition_option
from cobotwire.cli.shared.exit_codes import EPILOG, exit_on_errors, signals_as_interrupt
from cobotwire.cli.shared.lazy_group import LazyGroup

# The subcommands with their texts, in the order of --help, which imports none of them.
SUBCOMMANDS = {
    "demo": "Drive a simulated arm; check every reply.",
    "ports": "List serial ports, likely ones first.",
    "identify": "Find out which edition an arm speaks.",
    "doctor": "Examine an arm and its port; give advice.",
    "survey": "Find out which facts a real arm confirms.",
    "monitor": "Show joints, coordinates, rate, errors.",
    "tap": "Watch a program and its arm.",
    "call": "Send one command; print the result.",
    "run": "Run a program written for pymycobot.",
    "migrate": "Rewrite a program for our clients.",
    "decode": "Explain bytes, streams and recordings.",
    "export": "Write captures to Parquet, CSV, Arrow and MCAP.",
    "capture": "Show what recordings hold; cut, merge and repair them.",
    "sim": "Serve a simulated arm.",
    "studio": "Show an arm or a recording in the browser.",
    "mcp": "Offer an arm to a language model.",
    "ros2": "Publish an arm on the topics of ROS 2.",
    "replay": "Print a recording, or serve it as an arm.",
    "plot": "Draw a recording.",
    "conform": "Test an arm, a client or a codec.",
    "urdf": "Write a model of the arm for ROS and others.",
    "commands": "List the commands, or describe one.",
    "completion": "Print the completion script of a shell.",
}


class _App(LazyGroup):
    subcommands = SUBCOMMANDS
    modules = "cobotwire.cli."

    def list_commands(self, context: click.Context) -> list[str]:
        """Return the subcommands, without ``studio`` if the package was built without its page."""
        # Imported here, because only the list needs it: pathlib takes a twentieth of a start.
        from cobotwire.studio.extras import CURVES

        return [
            subcommand for subcommand in SUBCOMMANDS if subcommand != "studio" or CURVES.is_file()
        ]

    def invoke(self, context: click.Context) -> Any:
        with signals_as_interrupt(), exit_on_errors():
            return super().invoke(context)


def _print_version(context: click.Context, option: click.Parameter, wanted: bool) -> None:
    if wanted and not context.resilient_parsing:
        with exit_on_errors():
            click.echo(f"cobotwire {cobotwire.__version__}, {cobotwire.codec_in_use()} codec")
        context.exit()


@click.group(cls=_App, context_settings={"help_option_names": ["-h", "--help"]}, epilog=EPILOG)
@edition_option
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_print_version,
    help="Show the version and the codec in use.",
)
def app() -> None:
    """Control a robot arm, simulate one, and decode its serial traffic."""
