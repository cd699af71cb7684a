"""The simulated arm: one state and one clock, and a connection for each client."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from cobotwire import codec as codecs
from cobotwire.kinematics import Geometry, geometry_of
from cobotwire.protocol.addresses import devices_of, find_address
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.messages import Event
from cobotwire.protocol.roles import starts_motion
from cobotwire.protocol.table import Command, Table
from cobotwire.simulator.arm_connection import ArmConnection, Done, EventListener
from cobotwire.simulator.behaviour import Behaviour, own
from cobotwire.simulator.behaviour.external import installed
from cobotwire.simulator.devices import new_state
from cobotwire.simulator.effects import EVERY_JOINT, Requested, perform
from cobotwire.simulator.events import Events
from cobotwire.simulator.motion.hand import checked
from cobotwire.simulator.state import ArmState

NOTES_KEPT = 1000

Clock = Callable[[], float]


class Note(NamedTuple):
    """The reason why a command had no effect or waits; a real arm does not report it.

    Attributes:
        time: by the arm's clock, in seconds.
        command: the name of the command.
        text: the reason.
    """

    time: float
    command: str
    text: str


class SimulatedArm:
    """An arm that speaks an edition. Pass it your own clock to step its time.

    If the edition has addresses, every device that has one is an arm with a state of its own;
    ``state`` is that of the first, and :meth:`state_at` returns each.

    The arm is a peer (:mod:`cobotwire.simulator.peer`) for one client; :meth:`connect` adds more.
    """

    def __init__(
        self,
        table: Table,
        *,
        clock: Clock = time.monotonic,
        codec: codecs.CodecName | None = None,
        on_event: EventListener | None = None,
        acks: bool = True,
        powered: bool = False,
        geometry: Geometry | None = None,
        lag: float = 0.0,
        on_note: Callable[[Note], None] | None = None,
        behaviours: Mapping[str, Behaviour] | None = None,
    ) -> None:
        """Create an arm in the start state of its edition: by default every joint is at zero.

        Args:
            table: the edition that the arm speaks.
            clock: returns the time in seconds.
            codec: ``native`` or ``reference``; None: the default one.
            on_event: called with everything that the arm receives, and with its reply.
            acks: whether the arm sends the acknowledgements that the edition allows.
            powered: whether the arm has power from the start; after a restart it has none.
            geometry: the lengths of the links; None: those that the edition states. If
                it states none, the arm does not reply to queries of coordinates, and rejects
                motions to coordinates.
            lag: the delay of the joints behind the computed motion, in seconds.
            on_note: called with each new note; ``notes`` keeps the last 1000.
            behaviours: what the arm does for its commands, instead of the behaviour that comes with
                cobotwire; None: those that installed packages provide for the edition (entry
                points of the group ``cobotwire.behaviours``).
        """
        self.table = table
        self.clock = clock
        self.codec = codecs.load(table, codec)
        self.acks = acks
        self._on_event = on_event
        self._on_note = on_note
        self._notes: deque[Note] = deque(maxlen=NOTES_KEPT)
        self._geometry = geometry or geometry_of(table)
        self._lag = lag
        devices: list[int | None] = [device.value for device in devices_of(table)]
        # The state of each device by its address; None where frames have no address.
        self._states: dict[int | None, ArmState] = {
            address: self.new_state(address) for address in devices or [None]
        }
        if powered:
            for state in self._states.values():
                state.power_on()
        self.events = Events(table, self.codec, clock, self._states)
        self._behaviours = installed(table.edition) if behaviours is None else behaviours
        self._found: dict[str, Behaviour | None] = {}
        self._own_connection = ArmConnection(self, on_event)

    @property
    def state(self) -> ArmState:
        """The state of the arm; if devices have addresses, that of the first one."""
        return next(iter(self._states.values()))

    @state.setter
    def state(self, state: ArmState) -> None:
        self._states[next(iter(self._states))] = state

    @property
    def states(self) -> Mapping[int | None, ArmState]:
        """The state of each device by its address; the key is None where frames have no address."""
        return self._states

    def state_at(self, address: int | str) -> ArmState:
        """Return the state of the device that has an address.

        Raises:
            UsageError: the edition has no such address, or several devices have it.
        """
        found = find_address(self.table, address)
        if found is None or found.value not in self._states:
            names = ", ".join(device.name for device in devices_of(self.table))
            raise UsageError("address", address, names)
        return self._states[found.value]

    def receivers(self, address: int | None) -> tuple[int | None, ...]:
        """Return the addresses of the devices that receive a request to an address."""
        return (address,) if address in self._states else tuple(self._states)

    def connect(self, on_event: EventListener | None = None) -> ArmConnection:
        """Connect one more client: it shares the arm's state; its requests are parsed separately.

        ``on_event`` is called with what this client sends; None: the arm's own listener is called.
        """
        return ArmConnection(self, on_event or self._on_event)

    def lead(
        self,
        points: Iterable[tuple[float, Sequence[float]]],
        address: int | str | None = None,
    ) -> None:
        """Lead the arm by hand whenever no joint is held; if no joint is held now, begin at once.

        Args:
            points: for each point, the seconds since the release, and the joints' angles. The
                joints turn at constant speed from where they are to the first point, then to the
                next. They stay at the last point, and stop as soon as a joint is held. Empty:
                nobody leads the arm.
            address: which of several devices is led; None: the first.

        Raises:
            UsageError: a time is not after the one before, a point has not one angle per joint,
                or no single device has the address.
        """
        state = self.state if address is None else self.state_at(address)
        state.hand = checked(points, self.table.joints)
        if state.released:
            state.release(self.clock())

    def restart(self) -> None:
        """Lose all settings, as in a power cycle. The joints and the gripper keep their positions.

        The arm counts its starts.
        """
        now = self.clock()
        for address, before in self._states.items():
            self._states[address] = state = self.new_state(address)
            state.angles.place(before.standing(now), now)
            state.gripper.place(before.gripper.position(now), now)
            state.starts = before.starts + 1
            state.hand = before.hand
        self.events.forget()
        self._own_connection.reset()

    def emit(self, event: Event, address: int | str | None = None, *, after: float = 0.0) -> None:
        """Send an event to every client, now or ``after`` seconds; any thread may call this.

        ``address`` is that of the device; None: the first.

        Raises:
            UsageError: the edition has no such event or address, or does not allow its values.
        """
        state = self.state if address is None else self.state_at(address)
        sender = next(key for key, each in self._states.items() if each is state)
        self.events.emit(event, sender, self.clock() + after)

    @property
    def notes(self) -> tuple[Note, ...]:
        """The notes so far, the oldest first: at most 1000."""
        return tuple(self._notes)

    @property
    def pending(self) -> int:
        """The number of bytes of an incomplete request on the arm's own connection."""
        return self._own_connection.pending

    @property
    def wait(self) -> float | None:
        """Seconds until :meth:`flush` must be called if nothing is received; None: never."""
        return self._own_connection.wait

    def receive(self, data: bytes) -> bytes:
        """Receive ``data`` on the arm's own connection; return the replies."""
        return self._own_connection.receive(data)

    def flush(self) -> bytes:
        """Give up an incomplete request on the arm's own connection; return the replies."""
        return self._own_connection.flush()

    def take_events(self) -> bytes:
        """Return the events that are due on the arm's own connection."""
        return self._own_connection.take_events()

    def forget_client(self) -> None:
        """Forget an incomplete request on the arm's own connection; its client has left."""
        self._own_connection.forget_client()

    def perform(self, command: Command, fields: Mapping[str, Any], address: int | None) -> Done:
        """Perform a command; return the reply or some of its fields; the arm fills in the rest.

        ``fields`` are the fields of the request, as the codec decodes them. ``address`` is the
        address of the device; None if it has none.
        """
        state, now = self._states[address], self.clock()
        state.record(now)
        behaviour = self._behaviours.get(command.name) or self._own(command)
        elsewhere = self._is_elsewhere(fields)
        if elsewhere:
            # The arm has no such joint: values for it are stored and have no other effect.
            behaviour, state.at_once = None, starts_motion(self.table, command)
        try:
            if behaviour is not None:
                request = behaviour.request_type.from_fields(fields)
                return behaviour.behave(state, now, request)
            return perform(Requested(self.table, state, now, command, fields), elsewhere=elsewhere)
        finally:
            self.events.watch(command, address)
            for event, at in state.emitted:
                self.events.emit(event, address, at)
            state.emitted.clear()
            for text in state.remarks:
                self.note(command, text)
            state.remarks.clear()

    def _own(self, command: Command) -> Behaviour | None:
        """Return the behaviour of cobotwire for a command, which is looked up once."""
        if command.name not in self._found:
            self._found[command.name] = own(self.table, command)
        return self._found[command.name]

    def _is_elsewhere(self, fields: Mapping[str, Any]) -> bool:
        """Return whether a request is for a joint that is not in the arm, such as a waist joint."""
        joint = fields.get("joint")
        # The servo after the last joint is the gripper's.
        return isinstance(joint, int) and self.table.joints + 1 < joint < EVERY_JOINT

    def note(self, command: Command, text: str) -> None:
        """Add a note."""
        note = Note(self.clock(), command.name, text)
        self._notes.append(note)
        if self._on_note is not None:
            self._on_note(note)

    def new_state(self, address: int | None = None) -> ArmState:
        """Return the state after the start of the device that has an address, or of the arm."""
        return new_state(self.table, self._geometry, address, self._lag)
