"""Connect a conformance run with the device under test: a port, a program, or a simulated arm."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from cobotwire.conformance.device import DeviceConnection, StartedDevice, parse_command
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Table
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.arm import Note
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.memory import MemoryTransport
from cobotwire.transport import Transport, open_transport

IN_MEMORY = "simulated arm in memory"


@dataclass(frozen=True, slots=True)
class Subject:
    """The device to test or survey: a port, a program, a simulated arm or a recording."""

    url: str | None = None
    command: str | None = None
    attach: str | None = None
    simulated: bool = False
    baudrate: int | None = None
    recorded: Transport | None = None

    def validate(self) -> None:
        """Check it before anything is opened.

        Raises:
            UsageError: no device is named, or several are, or its command is not valid.
        """
        given = (self.url, self.command, self.recorded, self.simulated or None)
        if sum(each is not None for each in given) != 1:
            message = "give one of these: the URL of an arm, --command, or --simulated"
            raise UsageError("URL", self.url, message=message)
        if self.command is None and self.attach is not None:
            raise UsageError("attach", self.attach, message="--attach needs --command")
        if self.command is not None:
            parse_command(self.command, self.attach)


# How a simulated arm begins the note that it cannot reply.
NO_REPLY = "no reply: "


class Lacking:
    """What a simulated arm declares as unsupported, such as coordinates of an unknown geometry.

    ``reasons`` maps the name of each such command to the reason that the arm states.
    """

    def __init__(self, table: Table) -> None:
        self.reasons: dict[str, str] = {}
        self._table = table
        self._why = table.robot.why_no_geometry

    def note(self, note: Note) -> None:
        """Keep the reason, if a note of the arm says that it cannot reply."""
        if note.text.startswith(NO_REPLY) or note.text.endswith(self._why):
            id = self._table.command(note.command).id
            same = [command.name for command in self._table.commands if command.id == id]
            why = self._why if note.text.endswith(self._why) else note.text.removeprefix(NO_REPLY)
            self.reasons |= dict.fromkeys(same, why)


# How long a program may take until it replies, in seconds.
STARTING = 10.0


@contextmanager
def connected(table: Table, subject: Subject, lacking: Lacking) -> Iterator[DeviceConnection]:
    """Yield the connection with the device; at the end, stop the program if one was started.

    Raises:
        UsageError: see :meth:`Subject.validate`.
        LinkError: the port cannot be opened, or the program cannot be started.
    """
    subject.validate()
    baudrate = table.baudrate if subject.baudrate is None else subject.baudrate
    if subject.command is not None:
        command, attach = parse_command(subject.command, subject.attach)
        with StartedDevice(command, attach, baudrate) as started:
            yield DeviceConnection(started.transport)
    elif subject.recorded is not None:
        yield DeviceConnection(subject.recorded)
    elif subject.url is None:
        clock = SteppedClock()
        arm = SimulatedArm(table, clock=clock, on_note=lacking.note)
        yield DeviceConnection(MemoryTransport(arm, clock), clock, IN_MEMORY)
    else:
        opened = open_transport(subject.url, baudrate)
        try:
            yield DeviceConnection(opened)
        finally:
            opened.close()
