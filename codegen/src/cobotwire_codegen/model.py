"""The checked protocol: frozen records without behaviour beyond what follows from their fields.

Everything knows its place, so that a rule that fails can say where.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from cobotwire_codegen.errors import Place

Lines = tuple[tuple[int, int], ...]
SAFETY = ("query", "setting", "motion", "power", "persistent write")
CHECKS = ("footer", "crc16-modbus", "sum")
UNITS = (
    "degree",
    "degree_celsius",
    "hertz",
    "millimetre",
    "milliampere",
    "percent",
    "step_per_second",
    "tick",
    "volt",
)
CONFIDENCE = ("high", "medium", "low")
VERDICTS = ("consistent", "erratum", "label only", "text and byte disagree")
REASONS = (
    "no-header",
    "bad-address",
    "bad-length",
    "unknown-id",
    "bad-check",
    "truncated",
    "trailing",
    "bad-value",
)
ERRATUM_KINDS = ("text", "table", "title", "label", "example", "missing")


@dataclass(frozen=True, slots=True)
class Evidence:
    """One source's word on a disputed fact."""

    source: str
    lines: Lines
    says: str


@dataclass(frozen=True, slots=True)
class Dispute:
    """A fact that the sources do not agree on."""

    place: Place
    claim: str
    reading: str
    confidence: str
    evidence: tuple[Evidence, ...]


@dataclass(frozen=True, slots=True)
class Change:
    """What a delta edition does to its base, in words, and why."""

    place: Place
    what: str
    why: str
    evidence: tuple[Evidence, ...]


@dataclass(frozen=True, slots=True)
class Wire:
    """How a whole number stands on the wire."""

    place: Place
    name: str
    width: int
    order: Literal["big", "little"]
    signed_at: int
    doc: str
    source: Lines
    disputed: tuple[Dispute, ...]

    @property
    def minimum(self) -> int:
        """The lowest whole number that it can say."""
        return self.signed_at + 1 - 256**self.width if self.signed_at < self.top else 0

    @property
    def maximum(self) -> int:
        """The highest whole number that it can say."""
        return self.signed_at

    @property
    def top(self) -> int:
        """The highest raw word."""
        return int(256**self.width) - 1


@dataclass(frozen=True, slots=True)
class Quantity:
    """A wire type with a scale, a unit and a range (in that unit; None: all that can be said).

    ``choices`` closes the list of legal numbers on the wire. With ``radians`` the API speaks
    radians where the wire carries degrees.
    """

    place: Place
    name: str
    wire: Wire
    scale: Fraction
    unit: str
    range: tuple[Fraction, Fraction] | None
    choices: tuple[int, ...]
    radians: bool
    doc: str
    source: Lines
    disputed: tuple[Dispute, ...]

    @property
    def bounds(self) -> tuple[Fraction, Fraction]:
        """The range as whole numbers on the wire; with a denominator of 1 if it can be said."""
        if self.choices:
            return Fraction(min(self.choices)), Fraction(max(self.choices))
        if self.range is None:
            return Fraction(self.wire.minimum), Fraction(self.wire.maximum)
        return self.range[0] / self.scale, self.range[1] / self.scale


@dataclass(frozen=True, slots=True)
class Member:
    """One value of an enum."""

    place: Place
    name: str
    value: int
    doc: str


@dataclass(frozen=True, slots=True)
class Enum:
    """A closed list of values."""

    place: Place
    name: str
    class_name: str
    wire: Wire
    members: tuple[Member, ...]
    doc: str
    source: Lines


@dataclass(frozen=True, slots=True)
class Flag:
    """Yes or no, as 1 or 0."""

    place: Place
    name: str
    wire: Wire
    doc: str


@dataclass(frozen=True, slots=True)
class Value:
    """Several quantities that belong together: a named tuple."""

    place: Place
    name: str
    class_name: str
    items: tuple[tuple[str, Quantity], ...]
    doc: str


Type = Quantity | Enum | Flag | Value


@dataclass(frozen=True, slots=True)
class Field:
    """An argument of a request or a part of a reply.

    ``cases`` is empty but for a field whose type another field (``by``) decides: then it holds a
    type for each value of that field, and ``type`` is the first of them. A field with ``const``
    always holds that number; the caller does not give it.
    """

    place: Place
    name: str
    type: Type
    doc: str
    echo: Literal["", "required", "optional"]
    optional: bool
    const: int | None
    by: str
    cases: tuple[tuple[Member, Type], ...]


Form = tuple[Field, ...]


@dataclass(frozen=True, slots=True)
class Text:
    """Text outside any frame: a reply that ends by silence, or what follows a request."""

    place: Place
    class_name: str
    prefixes: tuple[str, ...]
    fields: tuple[tuple[str, str], ...]
    suffix: str
    silence_ms: int


@dataclass(frozen=True, slots=True)
class Command:
    """One call.

    ``requests`` and ``replies`` hold the forms of the messages, the full one first. With ``alias``
    the call is another one's message under a name of its own.
    """

    place: Place
    id: int
    name: str
    title: str
    doc: str
    safety: str
    source: Lines
    deadline_ms: int
    requests: tuple[Form, ...]
    replies: tuple[Form, ...]
    ack: bool
    alias: str
    text: Text | None
    request_text: Text | None
    notes: tuple[str, ...]
    disputed: tuple[Dispute, ...]
    changes: tuple[Change, ...]

    @property
    def reply(self) -> Form:
        """The full form of the reply; no fields where nothing answers."""
        return self.replies[0] if self.replies else ()

    @property
    def fields(self) -> tuple[Field, ...]:
        """The fields of every form of every message."""
        forms = (*self.requests, *self.replies)
        return tuple(dict.fromkeys(field for form in forms for field in form))

    def forms(self, direction: Literal["request", "reply"]) -> tuple[Form, ...]:
        """The forms of the message, the full one first; none where nothing answers."""
        return self.requests if direction == "request" else self.replies

    @property
    def answers(self) -> bool:
        """Whether an answer is due."""
        return (bool(self.replies) and not self.ack) or self.text is not None


@dataclass(frozen=True, slots=True)
class Family:
    """Commands that belong together: one file of the spec."""

    place: Place
    name: str
    title: str
    doc: str
    commands: tuple[Command, ...]


@dataclass(frozen=True, slots=True)
class Frame:
    """``header [address] LEN CMD DATA check``, and the link it travels on."""

    place: Place
    header: bytes
    check: Literal["footer", "crc16-modbus", "sum"]
    footer: bytes
    addresses: tuple[Member, ...]
    maximum_data: int
    doc: str
    baudrate: int
    deadline_ms: int

    @property
    def check_size(self) -> int:
        """Bytes of the check."""
        return len(self.footer) if self.check == "footer" else 2 if self.check != "sum" else 1


@dataclass(frozen=True, slots=True)
class Erratum:
    """A place where the document is wrong or contradicts itself, and how it is read."""

    place: Place
    lines: Lines
    kind: str
    commands: tuple[str, ...]
    example: int | None
    says: str
    read: str
    why: str


@dataclass(frozen=True, slots=True)
class Vector:
    """A frame with the values that it carries. ``example`` counts the document's own, from 1."""

    place: Place
    name: str
    example: int | None
    line: int | None
    command: str
    direction: Literal["request", "reply"]
    printed: bytes | None
    verdict: str
    frame: bytes | None
    text: str | None
    values: tuple[tuple[str, object], ...]
    says: str
    refused: tuple[str, int] | None


@dataclass(frozen=True, slots=True)
class Edition:
    """One edition of the protocol, whole."""

    place: Place
    name: str
    class_name: str
    title: str
    doc: str
    document: str
    firmware: str
    base: str
    joints: int
    frame: Frame
    wires: tuple[Wire, ...]
    types: tuple[Type, ...]
    families: tuple[Family, ...]
    errata: tuple[Erratum, ...]
    vectors: tuple[Vector, ...]
    changes: tuple[Change, ...]

    @property
    def commands(self) -> tuple[Command, ...]:
        """All commands, family by family."""
        return tuple(command for family in self.families for command in family.commands)
