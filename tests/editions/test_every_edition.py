"""Each further edition works everywhere: clients, simulator, recordings, columns.

The two editions of the 280 have tests of their own for all of this. An edition may be stated as a
difference from another one, so each of these tests checks whole editions. The conformance of
simulated arms is in ``tests/conformance/device/test_every_edition.py``.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import vectors
from both_ways import InLoop
from cobotwire import codec as codecs
from cobotwire.capture import read
from cobotwire.codec.interface import Frame
from cobotwire.conformance.client import Referee
from cobotwire.conformance.device.requests import harmless
from cobotwire.diagnose import Diagnoser
from cobotwire.editions import load
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Table
from cobotwire.simulator import MemoryTransport, PtyServer, SimulatedArm, TcpServer
from cobotwire.simulator.clock import SteppedClock

EDITIONS = vectors.further()
# Their replies need the lengths of the links, which no source may give.
BY_GEOMETRY = {"get_coords", "get_angles_coords", "get_coords_plan", "angles_to_coords"}
BY_GEOMETRY |= {
    "solve_inv_kinematics",
    "is_in_position",
    "is_in_position_coords",
    "get_joints_coord",
}
BY_GEOMETRY |= {"is_in_position_base_coords", "get_base_coords", "get_quick_move_info"}

# No source says what the simulated robot should reply about the gripper, about the whole robot, or
# in the frame of the base.
UNKNOWN = {
    "mybuddy": {
        *("get_coord", "get_base_coord", "get_base_coords", "collision", "get_angle"),
        *("single_to_base_coords", "base_to_single_coords"),
        *("is_waist_in_position", "is_robot_in_position"),
    }
}

POWERS = {"power_on", "set_robot_power_on", "focus_all_servos"}
# With mode 0, no joint is held after power_on, so later motions would be errors.
HOLDING = {"mode": 1}
CODECS: tuple[codecs.CodecName, ...] = ("native", "reference")

editions = pytest.mark.parametrize("edition", EDITIONS)


def calls(table: Table) -> Iterator[tuple[Command, dict[str, Any]]]:
    """Yield each command with harmless arguments, by name as a program passes them."""
    for command in table.commands:
        if command.event:
            continue
        if command.request_text is not None:
            yield command, dict.fromkeys(command.request_text.fields, "cobot")
            continue
        request: Request[Any] = harmless(command)[0]
        names = [name for name in command.argument_names if name in request.fields]
        yield command, {name: getattr(request, name) for name in names}


def unanswered(table: Table) -> set[str]:
    """Return the commands to which a simulated arm without a geometry does not reply."""
    known = table.robot.geometry is not None
    return set() if known else BY_GEOMETRY | UNKNOWN.get(table.edition, set())


def call_all(arm: Any, table: Table) -> int:
    """Call every command that is answered; return how many calls there were."""
    known = [pair for pair in calls(table) if pair[0].name not in unanswered(table)]
    for command, arguments in known:
        result = getattr(arm, command.name)(**arguments)
        assert (result is not None) == command.requires_reply, command.name
    return len(known)


@editions
def test_clients_call_every_command_of_a_simulated_arm(edition: str, tmp_path: Path) -> None:
    found = load(edition)
    path = tmp_path / "calls.pcapng"
    arm = SimulatedArm(found.TABLE, powered=True)
    with TcpServer(arm.connect) as server, found.CLIENT(server.url, record=path) as client:
        assert call_all(client, found.TABLE) >= len(found.TABLE.commands) - len(
            unanswered(found.TABLE)
        )
    with PtyServer(arm) as pty, InLoop(found.ASYNC_CLIENT, pty.url) as looped:
        call_all(looped, found.TABLE)
    check_recording(edition, path)


def check_recording(edition: str, path: Path) -> None:
    """Read a recording as frames, diagnosed items and columns, by both codecs."""
    table = load(edition).TABLE
    with read(path) as capture:
        packets = [(packet.direction, packet.data) for packet in capture]
        assert capture.interfaces[0][1:] == (edition, table.baudrate)
    replies = b"".join(data for direction, data in packets if direction == "received")
    texts = sum(command.text is not None for command in table.commands)
    required = sum(command.requires_reply for command, _ in calls(table)) - texts
    for name in CODECS:
        codec = codecs.load(table, name)
        framer, diagnoser = codec.framer("reply"), Diagnoser(codec)
        items = diagnoser.feed([*framer.feed(replies), *framer.flush()]) + diagnoser.flush()
        frames = sum(isinstance(item, Frame) for item in items)
        assert frames >= required - len(unanswered(table))
        assert len(items) - frames <= texts, "the rest is text"
        columns = codec.decode_columns(replies, "reply")
        assert sum(len(rows) for rows in columns) == frames
        assert len(columns.rejected) == 0


@editions
def test_client_conforms(edition: str) -> None:
    found, clock = load(edition), SteppedClock()
    referee = Referee(found.TABLE, clock=clock)
    with found.CLIENT(MemoryTransport(referee, clock)) as arm:
        for command, arguments in in_order(found.TABLE):
            if command.name not in unanswered(found.TABLE):
                held = HOLDING if command.name == "power_on" and arguments else {}
                getattr(arm, command.name)(**arguments | held)
                clock.sleep(0.1)
    report = referee.finish()
    assert report.failures == []
    assert report.conforms


def in_order(table: Table) -> list[tuple[Command, dict[str, Any]]]:
    """Return calls in an order in which a client makes no mistake.

    A motion without power is a mistake, so commands that switch the power off come last. To repeat
    a request is a mistake too, so a second command with the same id comes after other requests.
    """
    known = list(calls(table))
    ids = [command.id for command, _ in known]
    ranks = [
        (command.safety == "power" and command.name not in POWERS, ids.index(command.id) < at)
        for at, (command, _) in enumerate(known)
    ]
    return [known[at] for at in sorted(range(len(known)), key=ranks.__getitem__)]
