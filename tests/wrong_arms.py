"""Simulated arms that differ from their edition in one place, as a robot may; in stepped time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.codec.interface import Frame
from cobotwire.conformance.device import DeviceConnection
from cobotwire.protocol.table import Command, Field, Number, Table, Variant
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.faults import Late, Scenario
from cobotwire.simulator.memory import MemoryTransport
from cobotwire.simulator.peer import Peer

# No two joints are alike, none is at zero, and the arm is bent.
POSE = (20.0, -35.0, 50.0, -15.0, 40.0, 70.0)
Change = Callable[[Table], Table]


@dataclass(frozen=True)
class WrongArm:
    """An arm that differs from ``edition``, and the fact that a survey must name.

    ``change`` makes the table that the arm speaks. ``row`` changes the data bytes of the replies of
    ``command``.
    """

    name: str
    fact: str
    words: str
    change: Change | None = None
    edition: str = "mycobot280"
    command: str = ""
    row: Callable[[bytes], bytes] | None = None
    late: str = ""
    level: int = 1


def connected(
    table: Table, *, wrong: WrongArm | None = None, at: tuple[float, ...] = ()
) -> DeviceConnection:
    """Return the connection to a simulated arm of a table, perhaps a wrong one, at a pose."""
    spoken = wrong.change(table) if wrong is not None and wrong.change else table
    if at and spoken.joints == len(at):
        spoken = spoken._replace(robot=spoken.robot._replace(start_angles=at))
    clock = SteppedClock()
    peer: Peer = SimulatedArm(spoken, clock=clock)
    if wrong is not None and wrong.late:
        late = Late(seconds=0.7, commands=(wrong.late,))
        peer = Scenario(name="late", faults=(late,)).wrap(peer, codecs.load(spoken), clock=clock)
    transport = MemoryTransport(peer, clock)
    if wrong is not None and wrong.row is not None:
        transport.read = partial(_changed, wrong, table, transport.read)  # type: ignore[method-assign]
    return DeviceConnection(transport, clock, "wrong arm")


def _changed(
    wrong: WrongArm, table: Table, read: Callable[[float], bytes], timeout: float
) -> bytes:
    """Change the replies of a command, in frames without a check."""
    framer, found = codecs.load(table).framer("reply"), b""
    for event in (*framer.feed(read(timeout)), *framer.flush()):
        data = event.data
        if isinstance(event, Frame) and event.command == table.command(wrong.command).id:
            assert wrong.row is not None
            row = wrong.row(data[4:-1])
            data = data[:2] + bytes([len(row) + 2]) + data[3:4] + row + data[-1:]
        found += data
    return found


def with_command(table: Table, name: str, change: Callable[[Command], Command]) -> Table:
    """Return a table with one command changed."""
    return table._replace(
        commands=tuple(change(c) if c.name == name else c for c in table.commands)
    )


def without(table: Table, absent: Callable[[Command], bool]) -> Table:
    """Return a table without some commands."""
    return table._replace(commands=tuple(c for c in table.commands if not absent(c)))


def with_numbers(command: Command, change: Callable[[Number], Number]) -> Command:
    """Return a command with all numbers of its messages changed."""

    def field(old: Field) -> Field:
        cases = tuple(c._replace(numbers=tuple(map(change, c.numbers))) for c in old.cases)
        return old._replace(cases=cases)

    def changed(variants: tuple[Variant, ...]) -> tuple[Variant, ...]:
        return tuple(v._replace(fields=tuple(map(field, v.fields))) for v in variants)

    return command._replace(request=changed(command.request), reply=changed(command.reply))


def with_reply(table: Table, name: str, change: Callable[[Number], Number]) -> Table:
    """Return a table in which the numbers of a query's reply are changed."""
    return with_command(table, name, lambda command: with_numbers(command, change))


def swapped(row: bytes) -> bytes:
    """Swap the second and the third joint."""
    return row[:2] + row[4:6] + row[2:4] + row[6:]


def other_sign(row: bytes) -> bytes:
    """Change the sign of the second joint."""
    value = -int.from_bytes(row[2:4], "big", signed=True)
    return row[:2] + value.to_bytes(2, "big", signed=True) + row[4:]


def other_limits(table: Table) -> Table:
    """Return a table with half the targets, which are the limits of the simulated arm."""

    def halved(number: Number) -> Number:
        half = number.minimum // 2, number.maximum // 2
        return number._replace(minimum=half[0], maximum=half[1]) if number.unit else number

    return with_reply(table, "send_angles", halved)


NEWER = ("get_servo_speeds", "get_servo_voltages", "get_servo_temps", "get_reboot_count")


def takes_gripper_id(command: Command) -> bool:
    """Return whether a command is for a gripper of an id."""
    return any(field.name == "gripper_id" for field in command.request[0].fields)


# fmt: off
WRONG_ARMS = (
    WrongArm("tenths", "get_angles/reply.angles/scale",
             "the arm sends tenths, the edition states hundredths",
             lambda t: with_reply(t, "get_angles", lambda n: n._replace(divide=10)), "mycobot320"),
    WrongArm("swapped joints", "get_angles/reply.angles/order", "2 and 3 of the row are swapped",
             command="get_angles", row=swapped),
    WrongArm("reversed sign", "get_angles/reply.angles/sign",
             "number 2 of the row has the other sign", command="get_angles", row=other_sign),
    WrongArm("shifted id", "get_coords/command/present", "or has it under another id",
             lambda t: with_command(t, "get_coords", lambda c: c._replace(id=c.id + 0x80))),
    WrongArm("other endianness", "get_encoders/reply.encoders/byte-order", "endianness",
             lambda t: with_reply(t, "get_encoders", lambda n: n._replace(order="little"))),
    WrongArm("joint limits", "get_joint_max_angle/reply.angle/limits", "stated limits",
             other_limits),
    WrongArm("missing command", "get_servo_temps/command/present", "lacks it",
             lambda t: without(t, lambda c: c.name == "get_servo_temps")),
    WrongArm("gripper id", "get_pro_gripper_angle/command/present", "has another gripper_id",
             lambda t: without(t, takes_gripper_id), "mycobot320"),
    WrongArm("status list", "get_servo_status/reply/length", "expected a whole frame",
             command="get_servo_status", row=lambda row: row + b"\0"),
    WrongArm("late acknowledgement", "set_fresh_mode/command/deadline", "took 7",
             late="set_fresh_mode", level=2),
    WrongArm("other firmware", "get_reboot_count/command/present", "nor have 3 other commands",
             lambda t: without(t, lambda c: c.name in NEWER)),
    WrongArm("other robot", "", "the arm speaks edition mycobot, not mycobot280",
             lambda t: editions.load("mycobot").TABLE),
)
# fmt: on
