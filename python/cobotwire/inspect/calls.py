"""Send one command, or run one motion of the client, and report what became of it."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from inspect import signature
from types import MappingProxyType
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
from cobotwire.protocol.roles import row_index
from cobotwire.protocol.table import Role, Table
from cobotwire.session.motion import ack_seconds
from cobotwire.session.request import RequestEncoder
from cobotwire.simulator import MemoryTransport, SimulatedArm
from cobotwire.simulator.clock import SteppedClock


class Done(NamedTuple):
    """What a call did.

    Attributes:
        result: what the method returned; after a motion that was waited for, where the arm is.
        remark: how it went, in a sentence; empty if the result says that.
        facts: the same for programs.
    """

    result: Any
    remark: str = ""
    facts: Mapping[str, Any] = MappingProxyType({})


class CommandCall:
    """A call of a command, with its arguments."""

    on_error: OnError = "leave"

    def __init__(
        self, edition: Edition, name: str, words: Sequence[str], address: int | str | None
    ) -> None:
        """Parse and encode it.

        Raises:
            UsageError: there is no such command, or an argument is not allowed.
        """
        table = edition.TABLE
        command = table.command(name, also=motions(edition))
        if command.event:
            message = f"{name} is an event, which the device sends without a request"
            raise UsageError("command", name, message=message)
        self.name, self.starts_motion = name, command.starts_motion
        self._arguments = parse(command, words)
        encoder = RequestEncoder(codecs.load(table), find_address(table, address))
        encoded = encoder.encode_request(command.request_type(**self._arguments))
        self._ack_seconds = ack_seconds(encoded)

    def run(self, arm: Client, timeout: float | None) -> Done:
        """Send it; wait for its reply, or for its acknowledgement, which need not come."""
        method: Callable[..., Any] = getattr(arm, self.name)
        if self._ack_seconds is None:
            result = method(**self._arguments)
            if result is not None:
                return Done(result)
            remark = "sent; this request has no acknowledgement"
            return Done(None, remark, {"acknowledged": None})
        within = self._ack_seconds if timeout is None else timeout
        started = time.monotonic()
        try:
            method(**self._arguments, ack_within=within)
        except ReplyTimeout:
            remark = f"sent; not acknowledged within {1000 * within:.0f} ms"
            return Done(None, remark, {"acknowledged": False})
        seconds = time.monotonic() - started
        remark = f"sent; acknowledged after {1000 * seconds:.0f} ms"
        return Done(None, remark, {"acknowledged": True, "seconds": seconds})


class MotionCall:
    """A call of a motion that the client offers, with its arguments."""

    def __init__(
        self, edition: Edition, name: str, words: Sequence[str], address: int | str | None
    ) -> None:
        """Parse it, and validate it with a simulated arm.

        Raises:
            UsageError: an argument is not allowed, or the edition lacks a command for it.
        """
        method = motions(edition)[name]
        takes = signature(method).parameters
        self.name = name
        self._arguments = parse_method(method, _row_sizes(edition.TABLE), words)
        self._waits = "timeout" in takes and self._arguments.get("wait", True)
        self.on_error: OnError = "stop" if self._waits else "leave"
        # One that only waits starts no motion.
        self.starts_motion = "wait" in takes or "timeout" not in takes
        if self.starts_motion:
            transport = MemoryTransport(SimulatedArm(edition.TABLE), SteppedClock())
            at_once = {"wait": False} if "wait" in takes else {}
            with edition.CLIENT(transport, address=address) as simulated:
                getattr(simulated, name)(**{**self._arguments, **at_once})

    def run(self, arm: Client, timeout: float | None) -> Done:
        """Run it; wait until the arm is there, unless the arguments say otherwise."""
        started = time.monotonic()
        getattr(arm, self.name)(**self._arguments)
        seconds = time.monotonic() - started
        if not self._waits:
            return Done(None, "sent")
        role: Role = "coordinates" if "coords" in self._arguments else "joints"
        place = getattr(arm, arm.table.in_role(role).name)()
        return Done(place, f"arrived after {seconds:.1f} s", {"seconds": seconds})


Call = CommandCall | MotionCall


def motions(edition: Edition) -> dict[str, Callable[..., Any]]:
    """Return the methods with which a client moves its arm and waits, by name."""
    if not issubclass(edition.CLIENT, MovingClient):
        return {}
    return {name: each for name, each in vars(MovingClient).items() if not name.startswith("_")}


def prepare(
    edition: Edition, name: str, words: Sequence[str], address: int | str | None = None
) -> Call:
    """Parse and validate a call; nothing is sent to an arm.

    Raises:
        UsageError: there is no such command, or an argument is not allowed.
    """
    kind = MotionCall if name in motions(edition) else CommandCall
    return kind(edition, name, words, address)


def run(call: Call, arm: Client, *, force: bool, timeout: float | None) -> Done | CobotwireError:
    """Run a call, and check that the arm obeys it if it is a motion, unless ``force``.

    Returns:
        What it did. An error: the arm does not obey it or does not say so; nothing was sent, and
        what the arm does now need not be stopped.

    Raises:
        CobotwireError: the call failed.
    """
    checks = call.starts_motion and not force
    if checks:
        try:
            check_ready(arm, call.name)
        except (ArmNotReady, ReplyTimeout) as error:
            return error
    done = call.run(arm, timeout)
    if checks:
        check_accepted(arm, call.name)
    return done


def _row_sizes(table: Table) -> dict[str, int]:
    """Return how many numbers the targets of all joints and of the end have, by argument."""
    roles: tuple[Role, ...] = ("joint targets", "coordinate targets")
    variants = [command.request[0] for role in roles if (command := table.find_role(role))]
    rows = [variant.fields[row_index(variant)] for variant in variants]
    return {row.name: len(row.cases[0].numbers) for row in rows}
