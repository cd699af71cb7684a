"""Send one command, or run one motion of the client, and report the outcome."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from inspect import signature
from typing import Any, NamedTuple

from cobotwire import codec as codecs
from cobotwire.client import Client
from cobotwire.client.moving import MovingClient
from cobotwire.client.opening import OnError
from cobotwire.editions import Edition
from cobotwire.inspect.call_arguments import parse, parse_method
from cobotwire.inspect.readiness import check_accepted, check_ready
from cobotwire.protocol.addresses import find_address
from cobotwire.protocol.errors import ArmNotReady, CobotwireError, ReplyTimeout, UsageError
from cobotwire.protocol.roles import row_index, starts_motion
from cobotwire.protocol.table import Role, Table
from cobotwire.session.motion import ack_seconds
from cobotwire.session.request import RequestEncoder
from cobotwire.simulator import MemoryTransport, SimulatedArm
from cobotwire.simulator.clock import SteppedClock


class Done(NamedTuple):
    """The outcome of a call: the result, a remark (perhaps empty), and the facts as JSON data."""

    result: Any
    remark: str
    facts: dict[str, Any]


class Call(NamedTuple):
    """A call with valid arguments; ``send`` takes the client and the seconds for the reply."""

    name: str
    starts_motion: bool
    on_error: OnError
    send: Callable[[Client, float | None], Done]

    def run(
        self, arm: Client, url: str, *, force: bool, timeout: float | None
    ) -> Done | CobotwireError:
        """Send it; before a motion, check that the arm obeys, unless ``force``.

        Returns:
            The outcome; or an error if nothing was sent, so that no motion has to be stopped.

        Raises:
            CobotwireError: the call failed.
        """
        checks = self.starts_motion and not force
        if checks:
            try:
                check_ready(arm, self.name, url)
            except (ArmNotReady, ReplyTimeout) as error:
                return error
        done = self.send(arm, timeout)
        if checks:
            check_accepted(arm, self.name, url)
        return done


def motions(edition: Edition) -> dict[str, Callable[..., Any]]:
    """Return the methods with which a client moves its arm and waits, by name."""
    if not issubclass(edition.CLIENT, MovingClient):
        return {}
    return {name: each for name, each in vars(MovingClient).items() if not name.startswith("_")}


def prepare(
    edition: Edition, name: str, words: Sequence[str], address: int | str | None = None
) -> Call:
    """Parse and validate the call of a command or a motion; nothing is sent to an arm.

    Raises:
        UsageError: there is no such command, or an argument is not allowed.
    """
    make = _motion if name in motions(edition) else _command
    return make(edition, name, words, address)


def _command(edition: Edition, name: str, words: Sequence[str], address: int | str | None) -> Call:
    table = edition.TABLE
    command = table.command(name, also=motions(edition))
    if command.event:
        message = f"{name} is an event, which the device sends without a request"
        raise UsageError("command", name, message=message)
    arguments = parse(command, words)
    encoder = RequestEncoder(codecs.load(table), find_address(table, address))
    usual = ack_seconds(encoder.encode_request(command.request_type(**arguments)))

    def send(arm: Client, timeout: float | None) -> Done:
        method: Callable[..., Any] = getattr(arm, name)
        if usual is None:
            result = method(**arguments)
            if result is not None:
                return Done(result, "", {})
            return Done(None, "sent; this request has no acknowledgement", {"acknowledged": None})
        within = usual if timeout is None else timeout
        started = time.monotonic()
        try:
            method(**arguments, ack_within=within)
        except ReplyTimeout:
            # Older firmware sends no acknowledgements.
            remark = f"sent; not acknowledged within {1000 * within:.0f} ms"
            return Done(None, remark, {"acknowledged": False})
        seconds = time.monotonic() - started
        remark = f"sent; acknowledged after {1000 * seconds:.0f} ms"
        return Done(None, remark, {"acknowledged": True, "seconds": seconds})

    return Call(name, starts_motion(edition.TABLE, command), "leave", send)


def _motion(edition: Edition, name: str, words: Sequence[str], address: int | str | None) -> Call:
    method = motions(edition)[name]
    arguments = parse_method(method, _row_sizes(edition.TABLE), words)
    takes = signature(method).parameters
    waits = "timeout" in takes and arguments.get("wait", True)
    moves = "wait" in takes or "timeout" not in takes
    if moves:
        # A simulated arm checks whether the arguments are allowed.
        transport = MemoryTransport(SimulatedArm(edition.TABLE), SteppedClock())
        at_once = {"wait": False} if "wait" in takes else {}
        with edition.CLIENT(transport, address=address) as simulated:
            getattr(simulated, name)(**arguments | at_once)

    def send(arm: Client, timeout: float | None) -> Done:
        started = time.monotonic()
        getattr(arm, name)(**arguments)
        if not waits:
            return Done(None, "sent", {})
        seconds = time.monotonic() - started
        role: Role = "coordinates" if "coords" in arguments else "joints"
        place = getattr(arm, arm.table.in_role(role).name)()
        return Done(place, f"arrived after {seconds:.1f} s", {"seconds": seconds})

    return Call(name, moves, "stop" if waits else "leave", send)


def _row_sizes(table: Table) -> dict[str, int]:
    """Return how many numbers the targets of all joints and of the end have, by argument."""
    roles: tuple[Role, ...] = ("joint targets", "coordinate targets")
    variants = [command.request[0] for role in roles if (command := table.find_role(role))]
    rows = [variant.fields[row_index(variant)] for variant in variants]
    return {row.name: len(row.cases[0].numbers) for row in rows}
