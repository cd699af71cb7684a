"""The options for the geometry of an arm, from a URDF."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click


def geometry_options(subcommand: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options of subcommands that simulate or draw the arm."""
    file = click.option(
        "--geometry",
        type=click.Path(),
        metavar="URDF",
        help="Take the geometry of the arm from a URDF file; it is marked as unverified.",
    )
    tip = click.option(
        "--tip", metavar="LINK", help="With --geometry: the link that is the arm's flange."
    )
    return file(tip(subcommand))
