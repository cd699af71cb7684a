"""Load an edition's table from the ``edition.json`` that the generator wrote into its package."""

from __future__ import annotations

import json
import os
import sys
from binascii import crc32
from collections.abc import Iterator
from itertools import product
from typing import Any

from cobotwire.protocol.damage import damage_of
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.robot import load_robot
from cobotwire.protocol.table import (
    Address,
    Case,
    Check,
    Command,
    Crc,
    Field,
    FieldKind,
    FrameFormat,
    Number,
    ReadBack,
    Table,
    TextReply,
    TextRequest,
    Unsigned,
    Variant,
)
from cobotwire.protocol.type_records import (
    BYTE,
    Record,
    TypeRecords,
    choices_of,
    letters_of,
)

VERSION = 3
CARRIAGE_RETURN = b"\r"
# The kinds of types that are neither a number nor a tuple of numbers.
SHAPED = ("bits", "bytes", "text", "list")


def load_table(package: str, checksum: str | None = "") -> Table:
    """Return the table of a generated package, which is given by its full name.

    ``checksum`` is the checksum of ``edition.json``, as cobotwire-gen wrote it: a damaged table
    could move an arm in a way that nobody meant. None: the package is hand-written, and states
    none.

    Raises:
        UsageError: the file is missing or damaged, or another version of cobotwire-gen made it.
    """
    path, data = stored_file(package)
    found = checksum_of(data)
    if checksum in (found, None):
        document: Record = json.loads(data)
        if document["version"] == VERSION:
            return table_of(document, package)
        reason = f"it has version {document['version']} of the format, not {VERSION}"
    elif not checksum:
        reason = "another version of cobotwire-gen made the package: it states no checksum"
    else:
        damage = damage_of(data, lambda document: table_of(document, package))
        reason = f"{damage}; its checksum is {found}, not {checksum}"
    message = f"{path}: {reason}; generate the package again with cobotwire-gen"
    raise UsageError("edition", package, message=message)


def checksum_of(data: bytes) -> str:
    """Return the CRC-32 of an ``edition.json``, whatever ends its lines."""
    return f"{crc32(data.replace(CARRIAGE_RETURN, b'')):08x}"


def table_of(document: Record, package: str = "") -> Table:
    """Return the table of a document like ``edition.json``; its package has the message types."""
    edition, frame = document["edition"], document["frame"]
    reader = _Reader(document, package)
    return Table(
        edition["name"],
        edition["title"],
        edition["joints"],
        frame["baudrate"],
        load_frame(frame),
        tuple([reader.command(record) for record in document["commands"]]),
        load_robot(edition),
        tuple([Address(**address) for address in frame.get("addresses", ())]),
        tuple(edition.get("bases", ())),
    )


def load_frame(record: Record) -> FrameFormat:
    """Return the frame format of a record; keys that are left out have the format's defaults."""
    get = record.get
    default = FrameFormat(b"", b"", 0)
    return FrameFormat(
        bytes.fromhex(record["header"]),
        bytes.fromhex(get("footer", "")),
        record["maximum_length"],
        None if record["check"] == "footer" else _check(record),
        _addresses(record),
        tuple(get("layout", default.layout)),
        tuple(get("counted", default.counted)),
        Unsigned(**get("length", {})),
        Unsigned(**get("command", {})),
        not get("replies_without_id", False),
    )


def _addresses(record: Record) -> tuple[int, ...]:
    named = [address["value"] for address in record.get("addresses", ())]
    bounds = record.get("address_range")
    unnamed = range(bounds["first"], bounds["last"] + 1) if bounds else ()
    return (*named, *(value for value in unnamed if value not in named))


def _check(record: Record) -> Check:
    crc = record.get("crc")
    return Check(
        "crc" if crc else record["check"],
        record["check_from"],
        record["check_width"],
        record["check_order"],
        Crc(**crc) if crc else None,
    )


def load_sources(package: str) -> dict[str, Record]:
    """Return where each command comes from: ``place`` in the spec, ``lines`` and ``errata``.

    The place is ``file:line``, also of each change by a delta; lines and errata are those of the
    maker's document. The result is empty if a hand-written package does not state it. The table of
    the package was loaded before, so its file is as it was written.

    Raises:
        UsageError: the file of the errata is damaged.
    """
    try:
        document: Record = json.loads(stored_file(package)[1])
    except (KeyError, UsageError):
        return {}
    errata = _load_errata(package)
    return {
        record["name"]: {
            "place": record["place"],
            "lines": [[each["first"], each["last"]] for each in record.get("lines", ())],
            "errata": [each for each in errata if record["name"] in each["commands"]],
        }
        for record in document["commands"]
        if "place" in record
    }


def _load_errata(package: str) -> list[Record]:
    try:
        path, data = stored_file(package, "errata.json")
    except UsageError:
        # No errata are known of most documents.
        return []
    try:
        found: list[Record] = json.loads(data)["errata"]
        assert all(type(each["commands"]) is list for each in found)
    except (ValueError, LookupError, TypeError, RecursionError, AssertionError):
        message = f"{path} is damaged; generate the package again with cobotwire-gen"
        raise UsageError("edition", package, message=message) from None
    return found


def stored_file(package: str, name: str = "edition.json") -> tuple[str, bytes]:
    """Return the path and bytes of a package's file, also from inside a zip file.

    Raises:
        UsageError: it cannot be read.
    """
    module = sys.modules[package]
    path = os.path.join(os.path.dirname(str(module.__file__)), name)
    loader: Any = module.__spec__ and module.__spec__.loader
    try:
        data: bytes = loader.get_data(path)
    except OSError as error:
        message = f"{path} cannot be read: {error.strerror or error}; generate the package again"
        raise UsageError("edition", package, message=message) from None
    return path, data


class _Reader:
    """Turns the records of commands into those of a table."""

    def __init__(self, document: Record, package: str) -> None:
        self._package = package
        self._types = TypeRecords(document["wires"], document["types"])
        self._deadline = document["frame"]["deadline_ms"]
        self._most = document["frame"]["maximum_data"]

    def command(self, record: Record) -> Command:
        get = record.get
        text, request_text, read_by = get("text"), get("request_text"), get("read_by")
        return Command(
            record["id"],
            record["name"],
            record["title"],
            get("doc", ""),
            record["family"],
            record["safety"],
            record["deadline_ms"],
            self._variants(get("request", () if get("event") else ([],))),
            self._variants(get("reply", ())),
            text and TextReply(*_affixes(text), text.get("silence_ms", 0), text.get("suffix", "")),
            tuple(get("notes", ())),
            get("ack", False),
            request_text and TextRequest(*_affixes(request_text), request_text.get("suffix", "")),
            get("role", ""),
            read_by and ReadBack(read_by["query"], tuple([*map(_read_back, read_by["fields"])])),
            tuple([_sample(sample) for sample in get("samples", ())]),
            tuple(get("agrees_with", ())),
            tuple(get("arguments", ())),
            get("event", False),
            tuple(get("accepted", ())),
            self._package,
            get("effect"),
            get("firmware_versions"),
        )

    def _variants(self, records: list[list[Record]]) -> tuple[Variant, ...]:
        return tuple([made for fields in records for made in self._sized(fields)])

    def _sized(self, fields: list[Record]) -> Iterator[Variant]:
        """Yield a variant for each number of elements that a message may have."""
        varying = {
            field["name"]: sizes for field in fields if (sizes := self._sizes(field)) is not None
        }
        if not varying:
            yield self._variant(fields, {})
            return
        for counts in product(*[range(least, most + 1) for least, most in varying.values()]):
            variant = self._variant(fields, dict(zip(varying, counts)))
            if variant.size <= self._most:
                yield variant

    def _sizes(self, field: Record) -> tuple[int, int] | None:
        """Return the least and the most elements of a field if they differ."""
        type = self._types.record(field["type"]) if "type" in field else {}
        least, most = type.get("least", 1), type.get("most", 1)
        return (least, most) if least < most else None

    def _variant(self, fields: list[Record], counts: dict[str, int]) -> Variant:
        names = [field["name"] for field in fields]
        by_name = {field["name"]: field for field in fields}
        made = []
        for record in fields:
            counted = record.get("counts", "")
            if counted:
                field = self._field({**record, "const": counts[counted]}, names)
                sizes = self._sizes(by_name[counted])
                field = field._replace(sizes=sizes, counts=counted)
            elif "type" in record and self._types.record(record["type"])["kind"] in SHAPED:
                field = self._shaped(record, counts.get(record["name"]))
            else:
                field = self._field(record, names)
            made.append(field)
        return Variant(tuple(made))

    def _shaped(self, record: Record, count: int | None) -> Field:
        """Return a field of bits, bytes, a text or a list, with that many elements."""
        type = self._types.record(record["type"])
        kind: FieldKind = type["kind"] if type["kind"] in ("bytes", "text") else "number"
        each, of = 0, type
        element: tuple[Number, ...] = (BYTE,)
        if type["kind"] == "bits":
            element = type["numbers"]
        elif type["kind"] == "list":
            of = self._types.record(type["of"])
            if of["kind"] == "text":
                kind, element = "text", letters_of(of) * of["least"]
            else:
                element = self._types.numbers_of(type["of"])
                kind = of["kind"] if of["kind"] in ("enum", "flag") else "number"
            each = len(element) if of["kind"] in ("value", "text") else 0
        elif kind == "text":
            element = letters_of(type)
        members = of.get("members", ())
        return Field(
            record["name"],
            kind,
            (Case((), element * (type.get("least", 1) if count is None else count)),),
            record.get("doc", ""),
            True,
            choices_of(of) if type["kind"] == "list" else (),
            tuple([member["name"] for member in members]),
            echo="echo" in record,
            each=each,
            encoding=of.get("encoding", ""),
            padding=of.get("padding", -1),
            sizes=self._sizes(record),
        )

    def _field(self, record: Record, names: list[str]) -> Field:
        get = record.get
        selector = get("selector", "")
        types = get("cases") or ({"when": (), "type": record["type"]},)
        cases = tuple(
            [Case(tuple(case["when"]), self._types.numbers_of(case["type"])) for case in types]
        )
        first = self._types.record(types[0]["type"])
        const, kind = get("const"), first["kind"]
        choices: tuple[int, ...] = ()
        labels: tuple[str, ...] = ()
        if const is not None:
            choices = (const,)
        else:
            # Each case of a selected quantity has its own choices, in its number.
            choices = () if selector and first["kind"] == "quantity" else choices_of(first)
            labels = tuple([member["name"] for member in first.get("members", ())])
        return Field(
            record["name"],
            kind if kind in ("enum", "flag") else "number",
            cases,
            get("doc", ""),
            kind == "value",
            choices,
            labels,
            names.index(selector) if selector else -1,
            "echo" in record,
            const,
            tuple(default) if (default := get("default")) is not None else None,
            meanings=first["meanings"],
        )


def _read_back(record: Record) -> tuple[str, str | int]:
    return record["field"], record["argument"] if "argument" in record else record["value"]


def _sample(records: list[Record]) -> tuple[tuple[str, tuple[int, ...]], ...]:
    return tuple([(each["argument"], tuple(each["values"])) for each in records])


def _affixes(text: Record) -> tuple[tuple[str, ...], tuple[str, ...]]:
    return tuple(text["prefixes"]), tuple([field["name"] for field in text["fields"]])
