"""``cobotwire sim``: a simulated arm to talk to."""

from __future__ import annotations

import itertools
import sys
import threading
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial

import click

from cobotwire import editions
from cobotwire.cli.faults import chosen, scenario_options, with_faults
from cobotwire.cli.heard import SHOWN, Shown
from cobotwire.cli.joints import JointTable
from cobotwire.cli.serving import say, serve
from cobotwire.cli.view import View
from cobotwire.errors import UsageError
from cobotwire.session.device import DeviceEvent
from cobotwire.sim import PtyPort, RunningClock, Server, SimulatedArm, TcpPort
from cobotwire.sim.faults import Done, Scenario
from cobotwire.sim.kinematics import prepare
from cobotwire.sim.peer import Peer
from cobotwire.sim.tcp import address

FASTEST = 1e6
# Whoever serves for longer gets ready for answers that would else come late.
PREPARED_SECONDS = 0.5


@click.command()
@click.option("--pty", "on_pty", is_flag=True, help="Serve a pseudo-terminal [default].")
@click.option("--tcp", metavar="HOST:PORT", help="Serve TCP; :0 is any free port on loopback.")
@click.option("--speed", type=float, default=1.0, help="The arm's time: 2 runs twice as fast.")
@click.option("--quiet", is_flag=True, help="Print the port, but not what goes over the line.")
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object a line.")
@click.option("--view", metavar="PICTURE", help="Draw the arm into a .png, .svg or .pdf.")
@scenario_options
@click.pass_obj
def sim(
    edition: str,
    on_pty: bool,
    tcp: str | None,
    speed: float,
    quiet: bool,
    as_json: bool,
    scenario: str | None,
    seed: int | None,
    view: str | None,
) -> None:
    """Serve a simulated arm on a pseudo-terminal, or over TCP, until Ctrl-C.

    The first line is the port to open; then a line for everything that is heard and answered, for
    every order that is refused or ignored, with the reason, and for every fault that is done; and
    on a terminal a table of the joints. Over TCP several clients see the same arm; each line says
    whose it is. --view draws the arm at the beginning, whenever it has come to rest, and at the
    end.
    """
    if on_pty and tcp is not None:
        raise UsageError("--tcp", tcp, "one of --pty and --tcp")
    if not 0 < speed <= FASTEST:
        raise UsageError("speed", speed, f"above 0, up to {FASTEST:g}")
    package = editions.load(edition)
    shown = SHOWN["json" if as_json else "words"]
    clock = RunningClock(speed)
    remark = None if quiet else lambda note: say(shown.note(note))
    arm = SimulatedArm(package.TABLE, clock=clock, remark=remark)
    faults = chosen(scenario, seed, package.TABLE)
    lines = _Lines(arm, clock, faults, seed, None if quiet else shown)
    server = _server(lines, clock, tcp)
    with ExitStack() as stack:
        looks: list[Callable[[], None]] = []
        if sys.stdout.isatty() and not (quiet or as_json):
            looks.append(stack.enter_context(JointTable(package, arm, clock)).look)
        if view is not None:
            looks.append(stack.enter_context(View(package, arm, clock, view)).look)
        ready = threading.Timer(PREPARED_SECONDS, prepare)
        ready.daemon = True
        ready.start()
        stack.callback(ready.cancel)
        serve(server, shown.serving(server.url), looks)


def _server(lines: _Lines, clock: RunningClock, tcp: str | None) -> Server:
    if tcp is None:
        return PtyPort(lines.new(None), clock)
    numbers = itertools.count(1)
    host, port = address(tcp)
    server = TcpPort(lambda: lines.new(next(numbers)), host, port, clock)
    if not server.loopback:
        click.echo(f"cobotwire: whoever can reach {host} moves this arm unasked", err=True)
    return server


class _Lines:
    """Makes what answers each client: the one arm, behind faults, with all of it shown."""

    def __init__(
        self,
        arm: SimulatedArm,
        clock: RunningClock,
        scenario: Scenario | None,
        seed: int | None,
        shown: Shown | None,
    ) -> None:
        self._arm, self._clock = arm, clock
        self._scenario, self._seed, self._shown = scenario, seed, shown

    def new(self, client: int | None) -> Peer:
        line = self._arm.another_line(partial(self._heard, client))
        faulted = partial(self._faulted, client)
        return with_faults(line, self._scenario, self._seed, self._clock, faulted)

    def _heard(self, client: int | None, event: DeviceEvent, answer: bytes) -> None:
        if self._shown is not None:
            say(self._shown.event(client, event, answer))

    def _faulted(self, client: int | None, done: Done) -> None:
        if self._shown is not None:
            say(self._shown.fault(client, done))
