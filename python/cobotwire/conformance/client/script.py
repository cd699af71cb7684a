"""Compare what a client sends with a script, to find wrong scales, signs and byte orders."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec
from cobotwire.conformance.client.history import Received
from cobotwire.conformance.hex_text import shown
from cobotwire.conformance.located import LocatedNumber, located_numbers
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.conformance.tally import Observation
from cobotwire.protocol.addresses import address_name
from cobotwire.protocol.table import Command

SOURCE = "the script"
SCALE = TestCase("sent-scale", "Values are sent in the scale of their field.", SOURCE)
SIGN = TestCase("sent-sign", "Values are sent with their sign.", SOURCE)
BYTE_ORDER = TestCase("sent-byte-order", "Numbers are sent in the field's byte order.", SOURCE)
ORDER = TestCase("sent-order", "Values are sent in the order of the fields.", SOURCE)
ROUNDED = TestCase("sent-rounded", "Values are rounded to the nearest step.", SOURCE)
VALUE = TestCase("sent-value", "Values are sent as the script states them.", SOURCE)
ADDRESS = TestCase(
    "sent-address", "Requests are sent to the address that the script states.", SOURCE
)
VARIANT = TestCase(
    "sent-variant", "Requests are sent in the variant that the script states.", SOURCE
)
ONCE = TestCase("sent-once", "A change that is once in the script is sent once.", SOURCE)
ALL = TestCase("sent-all", "Everything in the script is sent.", SOURCE)
NOTHING_ELSE = TestCase("sent-nothing-else", "Nothing is sent that is not in the script.", SOURCE)

# One state machine, the class Script, checks all of these test cases.
SCRIPT = Group(
    "script",
    (SCALE, SIGN, BYTE_ORDER, ORDER, ROUNDED, VALUE, ADDRESS, VARIANT, ONCE, ALL, NOTHING_ELSE),
    None,
    subject="the calls of the script (`--expect`)",
)
# Factors by which a client may be wrong: powers of ten, and degrees in a radian.
_SCALES = (10, 100, 1000, 57.29577951308232)


class ScriptLine(NamedTuple):
    """A request that the client must send; ``place`` says where the script states it.

    ``variant`` is the index of its variant; None: the first that allows the values. ``address`` is
    that of the device; None: the edition's first one, if it has addresses.
    """

    command: Command
    values: tuple[Any, ...]
    place: str
    variant: int | None = None
    address: int | None = None


class Script:
    """Matches the received requests with the lines of a script."""

    def __init__(self, codec: Codec, lines: Sequence[ScriptLine]) -> None:
        """Encode the script.

        Raises:
            UsageError: the edition cannot express a line.
        """
        self._codec = codec
        self._lines = list(lines)
        self._frames = [
            codec.encode(
                line.command.name,
                "request",
                line.values,
                variant=line.variant,
                address=line.address,
            )
            for line in lines
        ]
        self._at = 0
        # The frame that was matched with the previous line: a client may repeat it, even if wrong.
        self._taken = b""

    def check(self, now: Received) -> Iterator[Observation]:
        """Check a frame, or a broken one, against the next line of the script."""
        if not now.is_frame:
            yield from self._broken(now)
            return
        data = now.data
        if self._at < len(self._frames) and data == self._frames[self._at]:
            self._at += 1
        elif self._at and data in (self._taken, self._frames[self._at - 1]):
            yield from self._again()
            return
        elif self._at < len(self._frames) and self._same_id(data):
            line = self._lines[self._at]
            found = differences(self._codec, line, self._frames[self._at], data)
            self._at += 1
            for case, reason in found:
                yield Observation(case, f"{line.place}: {reason}", line.command.name)
        else:
            yield from self._out_of_turn(now)
        self._taken = data

    def end(self) -> Iterator[Observation]:
        """Check what was never sent."""
        yield from self._missing(len(self._lines))
        self._at = len(self._lines)

    def _broken(self, now: Received) -> Iterator[Observation]:
        """Check a broken frame that was sent for the next line of the script."""
        if self._at == len(self._frames) or not self._is_meant(now.data):
            return
        line, right = self._lines[self._at], self._frames[self._at]
        self._at += 1
        self._taken = now.data
        sent = f"expected {shown(right)}, got the broken frame {shown(now.data)}"
        yield Observation(VARIANT, f"{line.place}: {sent}", line.command.name)

    def _is_meant(self, data: bytes) -> bool:
        """Return whether a broken frame has the id of the next line, or differs only in its id."""
        frame, right = self._codec.table.frame, self._frames[self._at]
        if len(data) < frame.head_size or not data.startswith(frame.header):
            return False
        id = frame.read_id(right)
        return frame.read_id(data) == id or (
            frame.check is None and frame.with_id(data, id) == right
        )

    def _same_id(self, data: bytes) -> bool:
        read_id = self._codec.table.frame.read_id
        same = read_id(data) == read_id(self._frames[self._at])
        return same and data not in self._frames[self._at :]

    def _again(self) -> Iterator[Observation]:
        """Check a repetition. A query may be repeated, because its reply may have been lost."""
        line = self._lines[self._at - 1]
        if line.command.safety != "query":
            yield Observation(ONCE, f"{line.place}: sent once more", line.command.name)

    def _out_of_turn(self, now: Received) -> Iterator[Observation]:
        """Check a frame that matches a later line of the script, or no line."""
        rest = self._frames[self._at :]
        if now.data in rest:
            later = self._at + rest.index(now.data)
            yield from self._missing(later)
            self._at = later + 1
        else:
            yield Observation(NOTHING_ELSE, f"{shown(now.data)} is not in the script", now.name)

    def _missing(self, end: int) -> Iterator[Observation]:
        for line in self._lines[self._at : end]:
            yield Observation(ALL, f"{line.place}: never sent", line.command.name)


def differences(
    codec: Codec, line: ScriptLine, right: bytes, sent: bytes
) -> list[tuple[TestCase, str]]:
    """Return the test cases that a frame of the right command fails, with the wrong values."""
    frames = f"expected {shown(right)}, got {shown(sent)}"
    table = codec.table
    meant, reached = table.frame.address(right), table.frame.address(sent)
    if meant is not None and reached is not None and meant != reached:
        names = f"expected {address_name(table, meant)}, got {address_name(table, reached)}"
        return [(ADDRESS, f"address: {names}: {frames}")]
    if len(right) != len(sent):
        return [(VARIANT, frames)]
    expected_data, sent_data = codec.table.frame.data(right), codec.table.frame.data(sent)
    wrong = [
        _Wrong(located, located.bytes_of(expected_data), located.bytes_of(sent_data))
        for located in _numbers(codec, line, right)
        if located.bytes_of(expected_data) != located.bytes_of(sent_data)
    ]
    if not wrong:
        return [(VALUE, frames)]
    values = "; ".join(map(str, wrong))
    if all(each.sent == each.right[::-1] for each in wrong):
        return [(BYTE_ORDER, f"{values}: with the bytes in reverse order")]
    if len(wrong) > 1 and sorted(w.right for w in wrong) == sorted(w.sent for w in wrong):
        return [(ORDER, f"{values}: the right values in another order")]
    found: dict[TestCase, list[str]] = {}
    for each in wrong:
        found.setdefault(each.case, []).append(str(each))
    return [(case, "; ".join(texts)) for case, texts in found.items()]


class _Wrong(NamedTuple):
    """A number that was sent with a wrong value."""

    located: LocatedNumber
    right: bytes
    sent: bytes

    @property
    def case(self) -> TestCase:
        """The test case that names the mistake."""
        number = self.located.number
        # A number without unit and scale selects something: a joint, a pin, a mode.
        if not number.unit and not number.real:
            return VALUE
        return _of_number(number.unpack(self.right), number.unpack(self.sent), number.real)

    def __str__(self) -> str:
        number = self.located.number
        expected, got = (
            _shown(self.located, number.unpack(raw)) for raw in (self.right, self.sent)
        )
        return f"{self.located.name}: expected {expected}, got {got}"


def _of_number(expected: int, got: int, rounds: bool) -> TestCase:
    """Return the test case for a wrong raw value; only a value with a scale is rounded."""
    if got == -expected:
        return SIGN
    if rounds and abs(got - expected) == 1:
        return ROUNDED
    for scale in _SCALES:
        for factor in (scale, 1 / scale, -scale, -1 / scale):
            if got and abs(expected * factor - got) <= 1:
                return SCALE
    return VALUE


def _numbers(codec: Codec, line: ScriptLine, frame: bytes) -> Iterator[LocatedNumber]:
    """Yield every number of the right frame of a line."""
    variant = codec.decode("request", frame, of=line.command.name).variant
    rows = variant.unpack(codec.table.frame.data(frame))
    return located_numbers(variant, {index: row[0] for index, row in enumerate(rows)})


def _shown(located: LocatedNumber, raw: int) -> str:
    return f"{located.number.physical(raw):g} {located.number.units}".rstrip()
