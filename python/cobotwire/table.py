"""The protocol as data: what the generator writes and what both codecs interpret.

An edition is one :class:`Table`. Nothing here knows a command by name, and nothing here does I/O:
the classes are plain records, so that the Rust codec can read the same objects attribute by
attribute. How the records are to be read is said once, in ``codec/reference``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from cobotwire.errors import UsageError

Direction = Literal["request", "reply"]
Safety = Literal["query", "setting", "motion", "power", "persistent write"]
Role = Literal[
    "",
    "joint targets",
    "joint target",
    "coordinate targets",
    "coordinate target",
    "reached",
    "moving",
    "stop",
    "joints",
    "coordinates",
    "powered",
    "version",
]
FieldKind = Literal["number", "flag", "enum"]
Check = Literal["footer", "crc16-modbus", "sum"]


@dataclass(frozen=True, slots=True)
class Number:
    """One number on the wire: ``width`` bytes, a sign rule, and a scale as an exact rational.

    The unsigned raw word ``w`` stands for the whole number ``w - 256**width`` if
    ``w > signed_at``, else ``w``. The physical value is ``whole * multiply / divide``; where
    ``multiply == divide == 1`` it is the whole number itself, an ``int``.
    ``minimum`` and ``maximum`` bound the *whole* number.
    """

    name: str
    width: int
    order: Literal["big", "little"]
    signed_at: int
    multiply: int
    divide: int
    minimum: int
    maximum: int
    unit: str

    @property
    def scaled(self) -> bool:
        """Whether the physical value is a float (True) or the whole number itself (False)."""
        return not self.multiply == self.divide == 1


@dataclass(frozen=True, slots=True)
class Case:
    """How a field reads while its selector holds one of ``when``; ``()`` where it has none."""

    when: tuple[int, ...]
    numbers: tuple[Number, ...]


@dataclass(frozen=True, slots=True)
class Field:
    """One argument of a request or one part of a reply.

    ``many`` fields are tuples, one element a number. ``choices`` closes the list of legal whole
    numbers (``()``: every one between minimum and maximum); ``labels`` names them, for people.
    Where ``selector`` is not -1, it is the index, in the same layout, of the field whose whole
    number picks the case; all cases of a field take the same number of bytes.
    """

    name: str
    kind: FieldKind
    cases: tuple[Case, ...]
    doc: str
    many: bool = False
    choices: tuple[int, ...] = ()
    labels: tuple[str, ...] = ()
    selector: int = -1
    echo: bool = False

    @property
    def size(self) -> int:
        """Bytes on the wire."""
        return sum(number.width for number in self.cases[0].numbers)


@dataclass(frozen=True, slots=True)
class Layout:
    """The data bytes of one form of a message."""

    fields: tuple[Field, ...]

    @property
    def size(self) -> int:
        """Data bytes on the wire, without header, LEN, command id and footer."""
        return sum(field.size for field in self.fields)


@dataclass(frozen=True, slots=True)
class TextReply:
    """A reply that is text outside any frame: ``prefixes[i]`` stands before ``fields[i]``.

    Its end shows only by ``silence_ms`` without another byte.
    """

    prefixes: tuple[str, ...]
    fields: tuple[str, ...]
    silence_ms: int
    suffix: str = ""


@dataclass(frozen=True, slots=True)
class TextRequest:
    """Text that follows a request outside any frame, as TextReply, and ends with ``suffix``."""

    prefixes: tuple[str, ...]
    fields: tuple[str, ...]
    suffix: str


@dataclass(frozen=True, slots=True)
class ReadBack:
    """How what a command has set is read: the ``query``, and what its reply then says.

    ``fields`` pairs a field of the reply with the argument whose value it repeats, or with the
    whole number that it then has; none: the fields of the same name. Arguments that the query
    shares by name choose what is read.
    """

    query: str
    fields: tuple[tuple[str, str | int], ...]


@dataclass(frozen=True, slots=True)
class Command:
    """One call: its id, how it is asked and how it is answered.

    ``request`` and ``reply`` hold the forms of the message, told apart by their size on the wire;
    the first is the full one. No ``reply`` and no ``text`` means that nothing answers. With ``ack``
    the reply is an acknowledgement that may come, late or never, and is not waited for. ``role`` is
    what hand-written code knows the command by. ``read_by`` tells how its effect is read.
    ``tries`` are the numbers by argument that a conformance run may send, for the first form that
    has these arguments; none: every legal one. ``agrees_with`` names queries that tell the same
    while the arm rests.
    """

    id: int
    name: str
    title: str
    doc: str
    family: str
    safety: Safety
    deadline_ms: int
    request: tuple[Layout, ...]
    reply: tuple[Layout, ...] = ()
    text: TextReply | None = None
    notes: tuple[str, ...] = ()
    ack: bool = False
    request_text: TextRequest | None = None
    role: Role = ""
    read_by: ReadBack | None = None
    tries: tuple[tuple[tuple[str, tuple[int, ...]], ...], ...] = ()
    agrees_with: tuple[str, ...] = ()

    @property
    def answers(self) -> bool:
        """Whether a reply is due."""
        return (bool(self.reply) and not self.ack) or self.text is not None

    def layouts(self, direction: Direction) -> tuple[Layout, ...]:
        """The forms of this command's message in one direction."""
        return self.request if direction == "request" else self.reply


@dataclass(frozen=True, slots=True)
class FrameFormat:
    """``header [address] LEN CMD DATA check``; LEN counts CMD, DATA and check.

    ``check`` is a fixed ``footer``; or a CRC-16/MODBUS over everything before it, high byte first;
    or the low byte of the sum of CMD and DATA. An address byte stands in the frame where
    ``addresses`` lists its legal values; the first one is sent unless the caller says otherwise.
    """

    header: bytes
    footer: bytes
    maximum_length: int
    check: Check = "footer"
    addresses: tuple[int, ...] = ()

    def length(self, data_size: int) -> int:
        """LEN of a frame with ``data_size`` data bytes."""
        return 1 + data_size + self.check_size

    @property
    def check_size(self) -> int:
        """Bytes of the check."""
        return (
            len(self.footer)
            if self.check == "footer"
            else {"crc16-modbus": 2, "sum": 1}[self.check]
        )

    @property
    def length_at(self) -> int:
        """Where LEN stands in a frame. CMD stands behind it."""
        return len(self.header) + (1 if self.addresses else 0)

    @property
    def overhead(self) -> int:
        """Bytes of a frame that LEN does not count: header, address and LEN itself."""
        return self.length_at + 1


@dataclass(frozen=True, slots=True)
class Table:
    """One edition of the protocol."""

    edition: str
    title: str
    joints: int
    baudrate: int
    frame: FrameFormat
    commands: tuple[Command, ...]

    def command(self, name: str) -> Command:
        """The command called ``name``.

        Raises:
            UsageError: there is none; the text names the nearest spelling.
        """
        for command in self.commands:
            if command.name == name:
                return command
        from difflib import get_close_matches  # only to tell what was wrong

        near = get_close_matches(name, [command.name for command in self.commands], n=1)
        hint = f"; did you mean {near[0]}?" if near else ""
        raise UsageError("command", name, f"a command of edition {self.edition}{hint}")

    def in_role(self, role: Role) -> Command:
        """The first command that has a role.

        Raises:
            UsageError: none has it.
        """
        for command in self.commands:
            if command.role == role:
                return command
        raise UsageError("role", role, f"a role that a command of edition {self.edition} has")
