"""``cobotwire ros2``: publish an arm on the topics of ROS 2, without ROS."""

from __future__ import annotations

import asyncio
import sys
from contextlib import ExitStack

import click

from cobotwire import editions
from cobotwire.capture.export.extras import needed
from cobotwire.cli.shared.arm_options import address_option, arm_options, parse_address
from cobotwire.cli.shared.completers import complete_ports
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.motion_options import MotionOptions, motion_options
from cobotwire.cli.shared.output import print_line, report_written
from cobotwire.protocol.addresses import check_one_moves

# The highest domain with valid port numbers: 7400 + 250 * 232 + 3999 < 65536.
_LAST_DOMAIN = 232


@click.command()
@click.argument("port", metavar="URL", shell_complete=complete_ports)
@arm_options
@address_option
@click.option(
    "--rate", type=float, default=20.0, show_default=True, help="Samples a second, at most."
)
@click.option(
    "--domain",
    type=click.IntRange(0, _LAST_DOMAIN),
    default=0,
    envvar="ROS_DOMAIN_ID",
    help="The DDS domain [default: ROS_DOMAIN_ID, or else 0].",
)
@click.option(
    "--interface",
    metavar="NAME|ADDRESS",
    help="The network interface to publish on [default: this computer only].",
)
@motion_options(silence=1.0)
@uses_edition
def ros2(
    edition: str,
    port: str,
    baudrate: int | None,
    record: str | None,
    address: str | None,
    rate: float,
    domain: int,
    interface: str | None,
    motion: MotionOptions,
) -> None:
    """Publish the arm at URL on the topics of ROS 2, until Ctrl-C; ROS need not be installed.

    /joint_states has the joints in radians, and /tf has the pose of the end of the arm in the
    frame `base`. /diagnostics has the state of the port and of the arm, once a second. Only queries
    are sent.

    With --allow-motion the arm follows the trajectories on /joint_trajectory, within the limits; it
    is stopped when nobody publishes that topic for --silence seconds, and at the end.

    Only programs on this computer find the topics, unless --interface,
    ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET or ROS_LOCALHOST_ONLY=0 says otherwise.
    """
    needed("cyclonedds", "ros2", "cobotwire ros2")
    # Imported here: the package of the extra may be absent.
    from cobotwire.adapters.ros2.bridge import Bridge
    from cobotwire.adapters.ros2.dds import Participant, network

    where = network(interface)
    to = None if address is None else parse_address(address)
    if motion.allowed:
        check_one_moves(editions.load(edition).TABLE, to)
    speed = int(motion.limits.speed or 100)
    silence = motion.silence if motion.allowed else None
    client = editions.load(edition).ASYNC_CLIENT(
        port,
        baudrate,
        record=record,
        address=to,
        on_error="stop" if motion.allowed else "leave",
        limits=motion.limits,
    )

    async def run(at_end: ExitStack) -> None:
        async with client as arm:
            if record is not None:
                at_end.callback(report_written, record)
            bridge = Bridge(arm, Participant(domain, where), port, rate, silence, speed)
            print_line(f"domain {domain} on {where.name}: {', '.join(bridge.topics)}")
            if motion.allowed:
                text = f"everyone on {where.name} can move the arm: DDS has no passwords"
                if where.local:
                    text = "a hostile computer can move the arm: DDS receives on all addresses"
                click.echo(f"cobotwire: {text}", err=True)
            await bridge.run()

    with ExitStack() as at_end:
        try:
            asyncio.run(run(at_end))
        except KeyboardInterrupt:
            # Ctrl-C is the usual way to end this subcommand, not a failure.
            sys.exit(0)
