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
    FrameFormat,
    ReadBack,
    Table,
    TextReply,
    TextRequest,
    Unsigned,
    Variant,
)
from cobotwire.protocol.type_records import Record, TypeRecords

VERSION = 3
CARRIAGE_RETURN = b"\r"


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

    The place is ``file:line``; each change by a delta edition adds its own. Lines and errata are
    those of the maker's document. The result is empty if a hand-written package does not state it.
    The table of the package was loaded before, so the file has the right checksum.

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
        """Return the smallest and the largest number of elements of a field, if they differ."""
        return self._types.field(field["type"]).sizes if "type" in field else None

    def _variant(self, fields: list[Record], counts: dict[str, int]) -> Variant:
        names = [field["name"] for field in fields]
        by_name = {field["name"]: field for field in fields}
        made = []
        for record in fields:
            field = self._field(record, names, counts)
            if field.counts:
                field = field._replace(sizes=self._sizes(by_name[field.counts]))
            made.append(field)
        return Variant(tuple(made))

    def _field(self, record: Record, names: list[str], counts: dict[str, int]) -> Field:
        """Return a field; ``counts`` are the numbers of elements of the fields that vary."""
        get, types = record.get, self._types
        name, selector, counted = record["name"], get("selector", ""), get("counts", "")
        const = counts[counted] if counted else get("const")
        if cases := get("cases"):
            field = types.field(cases[0]["type"])
            made = [Case(tuple(each["when"]), types.numbers_of(each["type"])) for each in cases]
        else:
            field = types.field(record["type"])
            made = [Case((), types.numbers_of(record["type"], counts.get(name)))]
        choices, labels = field.choices, field.labels
        if const is not None:
            choices, labels = (const,), ()
        elif selector and field.kind == "number":
            # Each case has its own choices, in its number.
            choices = ()
        return Field(
            name,
            field.kind,
            tuple(made),
            get("doc", ""),
            field.many,
            choices,
            labels,
            names.index(selector) if selector else -1,
            "echo" in record,
            const,
            tuple(default) if (default := get("default")) is not None else None,
            field.each,
            field.encoding,
            field.padding,
            field.sizes,
            counted,
            field.meanings,
        )


def _read_back(record: Record) -> tuple[str, str | int]:
    return record["field"], record["argument"] if "argument" in record else record["value"]


def _sample(records: list[Record]) -> tuple[tuple[str, tuple[int, ...]], ...]:
    return tuple([(each["argument"], tuple(each["values"])) for each in records])


def _affixes(text: Record) -> tuple[tuple[str, ...], tuple[str, ...]]:
    return tuple(text["prefixes"]), tuple([field["name"] for field in text["fields"]])
