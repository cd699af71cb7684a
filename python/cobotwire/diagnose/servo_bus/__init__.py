"""Read packets of the servo bus with its table, which is generated from ``spec/servo_bus.yaml``.

The table is loaded when the first packet is read. The reference codec reads it: a packet has one of
a thousand sizes, and the native codec would take 50 MB to hold a variant for each.
"""

from __future__ import annotations

from functools import cached_property, lru_cache
from typing import NamedTuple

from cobotwire.codec.events import DecodedMessage
from cobotwire.codec.reference.decode import read
from cobotwire.codec.reference.validator import Validator
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.frame_index import FrameIndex
from cobotwire.protocol.loading import load_table
from cobotwire.protocol.table import Command, Field, FrameFormat

# A polled arm repeats itself: this many different packets are remembered.
REMEMBERED = 4096


class Status(NamedTuple):
    """What a status packet says: its error bits by name."""

    errors: tuple[str, ...]


class Instruction(NamedTuple):
    """What an instruction says.

    ``name`` is "0x55" if the instruction is unknown. ``register``, ``register_name``, ``size`` (the
    number of bytes for each servo) and ``servos`` are None or empty if it names none.
    """

    name: str
    register: int | None = None
    register_name: str | None = None
    size: int | None = None
    servos: tuple[int, ...] = ()


class InstructionForm(NamedTuple):
    """The form of an instruction's packets.

    Attributes:
        code: the byte of the instruction.
        name: its name.
        lengths: the legal LENs.
        operands: the names of its parameters: ``register``, ``count``, ``data``, ``servos``.
        largest: the largest id in ``servos``.
    """

    code: int
    name: str
    lengths: list[int]
    operands: list[str]
    largest: int


class Vocabulary(NamedTuple):
    """What the native summary needs to read packets.

    Attributes:
        frame: the format of packets.
        lengths: the legal LENs.
        every: the id that stands for all servos.
        errors: the names and masks of the error bits of status packets.
        registers: the name of each register; empty if it has none.
        instructions: the instructions.
    """

    frame: FrameFormat
    lengths: list[int]
    every: int
    errors: list[tuple[str, int]]
    registers: list[str]
    instructions: list[InstructionForm]


class ServoBusReader:
    """Finds packets, and reads them as instructions and as status packets."""

    def __init__(self) -> None:
        self.table = table = load_table(__name__, checksum=None)
        self.every = next(a.value for a in table.addresses if a.replies == "none")
        requests, replies = FrameIndex(table, "request"), FrameIndex(table, "reply")
        self._validator = Validator(table.frame, [requests, replies])
        # A status packet carries no instruction, so these are legal with any byte after LEN.
        self.lengths = sorted(replies.lengths)
        self._requests = Validator(table.frame, [requests])
        self._names = {c.id: c.name.replace("_", " ") for c in table.commands}
        query = table.command("read")
        registers = _field(query.request[0].fields, "register")
        self.register_name = lru_cache(256)(registers.meaning)
        self._errors = _field(query.reply[0].fields, "errors").cases[0].numbers
        self._known = sum((1 << bit.bits) - 1 << bit.shift for bit in self._errors)
        self._sizes: dict[bytes, int] = {}
        self.status = lru_cache(512)(self._status)
        self.instruction = lru_cache(REMEMBERED)(self._instruction)

    @cached_property
    def vocabulary(self) -> Vocabulary:
        """What the native summary needs to read packets."""
        return Vocabulary(
            frame=self.table.frame,
            lengths=self.lengths,
            every=self.every,
            errors=[(bit.name, (1 << bit.bits) - 1 << bit.shift) for bit in self._errors],
            registers=[self.register_name(register) for register in range(256)],
            instructions=[self._form(command) for command in self.table.commands],
        )

    def _form(self, command: Command) -> InstructionForm:
        frame, fields = self.table.frame, command.request[0].fields
        servos = [field.cases[0].numbers[0] for field in fields if field.name == "servos"]
        return InstructionForm(
            code=command.id,
            name=self._names[command.id],
            lengths=[frame.length(variant.size) for variant in command.request],
            operands=[field.name for field in fields],
            largest=max((number.maximum for number in servos), default=0),
        )

    def size(self, data: bytes, at: int) -> int | None:
        """Return the size of the packet at ``at``; 0 if there is none, None for too few bytes."""
        frame = self.table.frame
        head = data[at : at + frame.head_size]
        if len(head) == frame.head_size:
            packet = data[at : at + frame.overhead + frame.read_length(head)]
            if packet in self._sizes:
                return self._sizes[packet]
        verdict = self._validator.validate(data, at)
        if not isinstance(verdict, int):
            return None if verdict == "truncated" else 0
        if len(self._sizes) >= REMEMBERED:
            self._sizes.clear()
        self._sizes[data[at : at + verdict]] = verdict
        return verdict

    def servo(self, packet: bytes) -> int:
        """Return the id of the servo; `every` stands for all servos."""
        return self.table.frame.address(packet) or 0

    def code(self, packet: bytes) -> int:
        """Return the byte that is an instruction or error bits."""
        return packet[self.table.frame.id_at]

    def parameters(self, packet: bytes) -> bytes:
        """Return the bytes between an instruction or error bits and the check."""
        return self.table.frame.data(packet)

    def name(self, code: int) -> str:
        """Return the name of an instruction, whatever its parameters are."""
        return self._names.get(code, f"0x{code:02X}")

    def unknown(self, code: int) -> Instruction:
        """Return an instruction that is known only by its name."""
        return Instruction(self.name(code))

    def _status(self, servo: int, code: int) -> Status | None:
        """Return what a status packet says; None if no servo sends a packet like that."""
        if servo == self.every or code & ~self._known:
            return None
        data = bytes([code])
        return Status(tuple([bit.name for bit in self._errors if bit.unpack(data)]))

    def _instruction(self, packet: bytes) -> Instruction | None:
        """Return what an instruction says; None if its parameters do not fit."""
        message = self._decoded(packet)
        if message is None:
            return None
        name, fields = self._names[message.command.id], message.fields
        register, data = fields.get("register"), fields.get("data", b"")
        count, servos = fields.get("count", len(data)), fields.get("servos", ())
        if register is None:
            return Instruction(name)
        if count != len(data) and data:
            # The data has, for each servo, its id and its bytes. No spec can state a list of groups
            # if another field holds their size.
            servos = tuple(data[:: count + 1])
        return Instruction(name, register, self.register_name(register) or None, count, servos)

    def _decoded(self, packet: bytes) -> DecodedMessage | None:
        if self.code(packet) not in self._names:
            return None
        try:
            return read(self._requests, packet)
        except ProtocolError:
            return None


def _field(fields: tuple[Field, ...], name: str) -> Field:
    return next(field for field in fields if field.name == name)


@lru_cache(maxsize=1)
def servo_bus() -> ServoBusReader:
    """Return the reader, which is made when it is first needed."""
    return ServoBusReader()
