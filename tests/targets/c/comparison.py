"""The C code of an edition, run on the shared vectors, under the sanitizers."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from typing import Any

from cobotwire_codegen.model import Edition
from cobotwire_codegen.targets.c.messages import messages
from cobotwire_codegen.targets.c.tables import Tables
from targets.c.compiled import COMPILERS, SANITIZERS, program
from targets.c.peer import CPeer, Outcome, Read, comparable
from targets.comparison import Comparison, ToolMissing, compared
from targets.vectors.comparison import PIECES, Record, as_written, read
from vectors import edition as edition_of


def compare(edition: str) -> Comparison:
    """Run the vectors of an edition, with the first compiler that is installed.

    Raises:
        ToolMissing: No compiler is installed.
    """
    compiler = next(filter(shutil.which, COMPILERS), None)
    if compiler is None:
        raise ToolMissing("a C compiler: gcc or clang")
    return validated(read(edition), edition_of(edition), compiler)


def validated(
    document: Record,
    edition: Edition,
    compiler: str,
    flags: tuple[str, ...] = SANITIZERS,
    name: str = "",
) -> Comparison:
    """Run a document's vectors on the C code of an edition, which may be a changed one."""
    with CPeer(program(edition, compiler, flags, name), edition) as peer:
        return Validator(edition, peer).compare(document)


class Validator:
    """Compare documents with what the C code does; text outside frames is not compared."""

    def __init__(self, edition: Edition, peer: CPeer) -> None:
        self._frame = edition.frame
        self._peer = peer
        self._messages = messages(edition)
        self._bits = Tables(edition).raw_bits
        self._index = {
            (message.command.name, message.direction, message.number): index
            for index, message in enumerate(self._messages)
        }

    def compare(self, document: Record) -> Comparison:
        """Compare every message, rejected value, malformed frame and stream."""
        rejected = [record for record in document["rejected"] if self._fits_struct(record)]
        comparers = {
            "messages": self._message,
            "rejected": self._rejected,
            "malformed": self._malformed,
            "streams": self._stream,
            "encoded": self._encoded,
        }
        return compared(document | {"rejected": rejected}, comparers)

    def _place(self, record: Record) -> int:
        return self._index[record["command"], record["direction"], record["variant"]]

    def _fits_struct(self, record: Record) -> bool:
        """Return whether the struct can hold the rejected value: no constant, and not too large."""
        found = self._messages[self._place(record)].members
        member = next(member for member in found if member.field.name == record["field"])
        field = next(field for field in record["fields"] if field["name"] == record["field"])
        raw, top = int(field["raw"][record["element"]]), 1 << (self._bits - 1)
        kinds = {leaf.kind for leaves in member.storage.cases for leaf in leaves}
        if "BYTE" in kinds:
            return 0 <= raw < 256
        return member.count > 0 and ("RAW" not in kinds or -top <= raw < top)

    def _message(self, record: Record) -> Iterator[str]:
        index, data = self._place(record), bytes.fromhex(record["bytes"])
        raw = self._given(record, "raw")
        values = [float(value) for value in self._given(record, "value")]
        address = data[self._frame.offset("address")] if self._frame.address_values else 0
        right = Read(index, raw, list(map(comparable, values)))
        frame = bytes.fromhex(record["built" if "built" in record else "bytes"])
        yield from _unequal("built", self._peer.encode(index, raw, address), frame)
        yield from _unequal(
            "built of values", self._peer.encode_values(index, values, address), frame
        )
        yield from _unequal("read", self._peer.decode(index, data), right)
        found = self._peer.read(record["direction"], data)
        name = self._messages[found.message].command.name if isinstance(found, Read) else found
        yield from _unequal("read as", name, record["read_as"])

    def _rejected(self, record: Record) -> Iterator[str]:
        address = (self._frame.address_values or (0,))[0]
        found = self._peer.encode(self._place(record), self._given(record, "raw"), address)
        yield from _unequal("built", self._where(found), (record["field"], record["element"]))

    def _where(self, found: bytes | Outcome) -> object:
        if isinstance(found, bytes) or found.status != "bad-value":
            return found
        member = self._messages[found.message].members[found.field]
        return member.field.name, found.element

    def _malformed(self, record: Record) -> Iterator[str]:
        data = bytes.fromhex(record["bytes"])
        if "command" in record:
            found = self._peer.decode(self._place(record), data)
        else:
            found = self._peer.read(record["direction"], data)
        outcome = (found.status, found.offset) if isinstance(found, Outcome) else found
        yield from _unequal("read", outcome, (record["reason"], record["offset"]))
        if isinstance(found, Outcome) and record.get("rejects"):
            message = self._messages[found.message]
            name = f"{message.command.name}: {message.members[found.field].field.name}"
            yield from _unequal("rejected", name, record["rejects"])

    def _encoded(self, record: Record) -> Iterator[str]:
        values = [float(value) for value in self._given(record, "value")]
        found = self._where(self._peer.encode_values(self._place(record), values))
        rejected = (record.get("field"), record.get("element"))
        right = bytes.fromhex(record["bytes"]) if "bytes" in record else rejected
        yield from _unequal("built", found, right)

    def _stream(self, record: Record) -> Iterator[str]:
        data = bytes.fromhex(record["bytes"])
        for size in PIECES:
            pieces = [(data[at : at + size], False) for at in range(0, len(data), size)]
            events, _ = self._peer.events(record["direction"], [*pieces, (b"", True)])
            yield from _unequal(f"in pieces of {size}", as_written(events), record["events"])

    def _given(self, record: Record, key: str) -> list[Any]:
        """Return the numbers of a record in the order of the message's struct."""
        given = {field["name"]: field[key] for field in record["fields"]}
        found: list[Any] = []
        for member in self._messages[self._place(record)].fields:
            numbers, stored = given[member.field.name], member.storage
            if member.counter:
                found.append(len(numbers) // (stored.each * len(stored.cases[0])))
            found += numbers
        return found


def _unequal(what: str, found: object, right: object) -> Iterator[str]:
    if found != right:
        yield f"{what} {found}, not {right}"
