"""Serve a simulated arm with faults on its line, and record what it receives."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from cobotwire import codec as codecs
from cobotwire.editions.mycobot import TABLE, GetEncoder
from cobotwire.session.device import DeviceEvent
from cobotwire.simulator import PtyServer, SimulatedArm, TcpServer
from cobotwire.simulator.behaviour import Behaviours
from cobotwire.simulator.faults import Fault, Scenario

# The reply shows which request it belongs to: the encoder of a joint is the joint's number.
BEHAVIOURS = Behaviours()
BEHAVIOURS.query(GetEncoder, lambda arm, now, request: request.joint)


@contextmanager
def faulty_arm(*faults: Fault, kind: str = "pty") -> Iterator[tuple[str, list[DeviceEvent]]]:
    """Serve an arm on a pty or over TCP; yield its URL, and the list of what it received."""
    received: list[DeviceEvent] = []
    arm = SimulatedArm(
        TABLE, behaviours=BEHAVIOURS, on_event=lambda event, reply: received.append(event)
    )
    peer = Scenario(name="faulty", faults=faults).wrap(arm, codecs.load(TABLE))
    with PtyServer(peer) if kind == "pty" else TcpServer(lambda: peer) as server:
        yield server.url, received
