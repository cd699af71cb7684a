"""``cobotwire sim``: serve a simulated arm."""

from __future__ import annotations

import itertools
import sys
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial

import click

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.cli.shared.completers import complete_scenarios
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.geometry_options import geometry_options
from cobotwire.cli.shared.line_output import LineOutput
from cobotwire.cli.shared.output import report_written
from cobotwire.cli.shared.serving import serve
from cobotwire.cli.shared.simulator_output import JsonLines, Lines
from cobotwire.kinematics.urdf_reading import with_urdf
from cobotwire.protocol.errors import UsageError
from cobotwire.session.device import DeviceEvent
from cobotwire.simulator import PtyServer, RunningClock, Server, SimulatedArm, TcpServer
from cobotwire.simulator.behaviour.external import named
from cobotwire.simulator.faults import AppliedFault, Scenario, find, shipped
from cobotwire.simulator.local import local_server
from cobotwire.simulator.motion.hand import read_points
from cobotwire.simulator.peer import Peer
from cobotwire.simulator.tcp import address

FASTEST = 1e6


def _list_scenarios(context: click.Context, option: click.Parameter, wanted: bool) -> None:
    """Print the fault scenarios that come with cobotwire, and exit."""
    if not wanted or context.resilient_parsing:
        return
    names = shipped()
    width = max(map(len, names))
    for name in names:
        click.echo(f"{name:<{width}}  {find(name).about}")
    context.exit()


@click.command()
@click.option(
    "--pty", "on_pty", is_flag=True, help="Serve a pseudo-terminal [default; on Windows TCP]."
)
@click.option("--tcp", metavar="HOST:PORT", help="Serve TCP; :0 is any free port on loopback.")
@click.option(
    "--speed",
    type=float,
    default=1.0,
    show_default=True,
    help="The arm's speed: 2 is twice as fast.",
)
@click.option("--powered", is_flag=True, help="The arm has power from the start.")
@click.option("--no-acks", is_flag=True, help="Send no acknowledgements, like older firmware.")
@click.option(
    "--led",
    type=click.Path(),
    metavar="FILE",
    help="Simulate a hand that leads the released arm; a line of FILE has seconds, then angles.",
)
@click.option(
    "--behaviours",
    metavar="MODULE",
    help="A module or .py file with `behaviours`: what the device does for its commands.",
)
@geometry_options
@click.option("--quiet", is_flag=True, help="Print the port, but no traffic.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object per line.")
@click.option(
    "--view",
    type=click.Path(),
    metavar="PICTURE",
    help="Draw the arm into a .png, .svg or .pdf file.",
)
@click.option(
    "--scenario",
    shell_complete=complete_scenarios,
    help="Inject faults: a YAML file, or a name that --list-scenarios prints.",
)
@click.option("--seed", type=int, help="With --scenario: replace the seed of the scenario.")
@click.option(
    "--list-scenarios",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_list_scenarios,
    help="List the fault scenarios that come with cobotwire.",
)
@uses_edition
def sim(
    edition: str,
    on_pty: bool,
    tcp: str | None,
    speed: float,
    powered: bool,
    no_acks: bool,
    led: str | None,
    behaviours: str | None,
    geometry: str | None,
    tip: str | None,
    quiet: bool,
    as_json: bool,
    view: str | None,
    scenario: str | None,
    seed: int | None,
) -> None:
    """Serve a simulated arm on a pseudo-terminal, or over TCP, until Ctrl-C.

    The first line of output is the port to open. The next lines show each request with its reply,
    each request that the arm rejects or ignores, with the reason, and each injected fault. On a
    terminal a table shows the joints. Over TCP several clients share the arm, and each line starts
    with the number of the client. --view draws the arm at the start, whenever it comes to rest, and
    at the end.
    """
    if on_pty and tcp is not None:
        raise UsageError("--tcp", tcp, message="use either --pty or --tcp, not both")
    if not 0 < speed <= FASTEST:
        raise UsageError("speed", speed, f"above 0, up to {FASTEST:.0f}")
    if scenario is None and seed is not None:
        raise UsageError("seed", seed, message="--seed needs --scenario")
    package = editions.load(edition)
    table = with_urdf(package.TABLE, geometry, tip)
    output = JsonLines() if as_json else Lines()
    lines = LineOutput(output.left_out)
    clock = RunningClock(speed)
    on_note = None if quiet else lambda note: lines.print(output.note(note))
    arm = SimulatedArm(
        table,
        clock=clock,
        on_note=on_note,
        powered=powered,
        acks=not no_acks,
        behaviours=None if behaviours is None else named(behaviours),
    )
    if led is not None:
        arm.lead(read_points(led, table.joints))
    faults = None if scenario is None else find(scenario, table)
    peers = _Peers(arm, clock, faults, seed, None if quiet else output, lines)
    server = _server(peers, clock, on_pty, tcp)
    with ExitStack() as stack:
        between: list[Callable[[], None]] = [] if quiet else [lines.flush]
        stack.callback(lines.close)
        if sys.stdout.isatty() and not (quiet or as_json):
            # Imported here, as below: most runs need neither a table nor a plot.
            from cobotwire.cli.shared.joint_table import JointTable

            joints = stack.enter_context(JointTable(package, arm, clock))
            lines.redirect(joints.add_line)
            between.append(joints.update)
        if view is not None:
            from cobotwire.inspect.plot.live_pose import LivePose

            stack.callback(report_written, view)
            between.append(stack.enter_context(LivePose(package, arm, clock, view)).update)
        serve(server, output.serving(server.url, table), between)


def _server(peers: _Peers, clock: RunningClock, on_pty: bool, tcp: str | None) -> Server:
    if tcp is None:
        peer = peers.new(None)
        return PtyServer(peer, clock) if on_pty else local_server(peer, clock)
    numbers = itertools.count(1)
    host, port = address(tcp)
    server = TcpServer(lambda: peers.new(next(numbers)), host, port, clock)
    if not server.loopback:
        click.echo(f"cobotwire: anyone who can reach {host} can move this arm", err=True)
    return server


class _Peers:
    """Creates the arm's end of each connection; it injects faults and prints the traffic."""

    def __init__(
        self,
        arm: SimulatedArm,
        clock: RunningClock,
        scenario: Scenario | None,
        seed: int | None,
        output: Lines | JsonLines | None,
        lines: LineOutput,
    ) -> None:
        self._arm, self._clock = arm, clock
        self._scenario, self._seed = scenario, seed
        self._output, self._lines = output, lines

    def new(self, client: int | None) -> Peer:
        arm = self._arm.connect(partial(self._print_event, client))
        if self._scenario is None:
            return arm
        return self._scenario.wrap(
            arm,
            codecs.load(self._arm.table),
            clock=self._clock,
            seed=self._seed,
            on_fault=partial(self._print_fault, client),
        )

    def _print_event(self, client: int | None, event: DeviceEvent, reply: bytes) -> None:
        if self._output is not None:
            self._lines.print(self._output.event(client, event, reply))

    def _print_fault(self, client: int | None, done: AppliedFault) -> None:
        if self._output is not None:
            self._lines.print(self._output.fault(client, done))
