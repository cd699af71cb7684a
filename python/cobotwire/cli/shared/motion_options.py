"""The options of every subcommand that lets others move an arm: pages, programs, machines."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, NamedTuple

import click

from cobotwire.client.opening import check_seconds
from cobotwire.protocol.limits import AXES, Limits, Range, checked_ranges

Subcommand = Callable[..., Any]


class MotionOptions(NamedTuple):
    """The options that permit, limit and end motions that others send."""

    allowed: bool
    limits: Limits
    silence: float


def _parse_workspace(
    context: click.Context, option: click.Parameter, text: str | None
) -> list[Range | None] | None:
    if text is None:
        return None
    try:
        ranges = [_range(part) for part in text.split(",")]
        return checked_ranges("workspace", ranges, len(AXES))
    except ValueError:
        message = (
            f"{text!r} is not a workspace; allowed: a range in mm for each of x, y and z, such as "
            "-200:200,-200:200,50:400; an empty range limits nothing"
        )
        raise click.BadParameter(message) from None


def _range(text: str) -> Range | None:
    if not text:
        return None
    low, high = map(float, text.split(":"))
    return low, high


def motion_options(silence: float) -> Callable[[Subcommand], Subcommand]:
    """Return a decorator that gives a subcommand these options as its argument ``motion``.

    ``silence`` is the default of ``--silence``.
    """
    options = (
        click.option(
            "--allow-motion",
            is_flag=True,
            help="Permit more than queries: also motions and changes of the arm.",
        ),
        click.option(
            "--max-speed",
            type=float,
            metavar="PERCENT",
            help="The highest speed, 1 to 100; motions without a speed in percent are refused.",
        ),
        click.option(
            "--workspace",
            callback=_parse_workspace,
            metavar="X:X,Y:Y,Z:Z",
            help="Where the end of the arm may be sent, in mm, such as -200:200,-200:200,50:400.",
        ),
        click.option(
            "--silence",
            type=float,
            metavar="SECONDS",
            default=silence,
            show_default=True,
            help="Stop a motion if its sender is silent for this long.",
        ),
    )

    def give(subcommand: Subcommand) -> Subcommand:
        @wraps(subcommand)
        def with_motion(
            *arguments: Any,
            allow_motion: bool,
            max_speed: float | None,
            workspace: list[Range | None] | None,
            silence: float,
            **named: Any,
        ) -> Any:
            check_seconds("silence", silence)
            limits = Limits(speed=max_speed, workspace=workspace)
            motion = MotionOptions(allow_motion, limits, silence)
            return subcommand(*arguments, motion=motion, **named)

        made: Subcommand = with_motion
        for option in reversed(options):
            made = option(made)
        return made

    return give
