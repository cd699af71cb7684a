"""The description of the language is complete, and its examples and its page are correct."""

from __future__ import annotations

import re
from collections import defaultdict
from typing import Any

import pytest
from jsonschema import Draft7Validator

import vectors
from cobotwire_codegen import language
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.errors import Problem, SpecError
from cobotwire_codegen.language.edition import FILES
from cobotwire_codegen.language.limits import COMMAND_LIMITS, LIMITS, NO_COMMAND, Limit
from cobotwire_codegen.language.records import Choice, Key, Record
from cobotwire_codegen.language.reference import language_page
from cobotwire_codegen.language.schema import editor_schema, records
from cobotwire_codegen.language.shapes import Word
from cobotwire_codegen.load import Node, parse
from cobotwire_codegen.project import edition_files
from cobotwire_codegen.reader import Reader
from codegen.author import samples
from random_formats import in_format

RECORDS = [one for one in records(FILES.values()) if not isinstance(one, Choice)]
DEFINITIONS = editor_schema([])["definitions"]
WITH_EXAMPLE = [record for record in RECORDS if record.EXAMPLE]


def _name(record: type[Record]) -> str:
    return record.definition()


def test_builders_read_every_key_of_every_record(monkeypatch: pytest.MonkeyPatch) -> None:
    read: dict[type[Record], set[str]] = defaultdict(set)
    inner = Reader.node

    def node(self: Reader, key: Key[Any]) -> Node | None:
        read[self.record].add(key.name)
        return inner(self, key)

    monkeypatch.setattr(Reader, "node", node)
    for path in edition_files(vectors.ROOT):
        build_edition(path, vectors.ROOT)
    for name in samples.EDITIONS:
        build_edition(samples.FOLDER / name, samples.FOLDER)
    for record in RECORDS:
        assert read[record] == set(record.keys()), record.definition()


def test_reading_a_key_that_the_record_does_not_describe_fails() -> None:
    reader = Reader(parse("errata: []", "a.yaml"), language.ErrataFile, "the errata file", [])
    with pytest.raises(AssertionError, match="ErrataFile describes no vectors"):
        reader.get(language.VectorsFile.vectors)


@pytest.mark.parametrize("record", WITH_EXAMPLE, ids=_name)
def test_example_of_a_record_is_valid_by_schema_and_reader(record: type[Record]) -> None:
    assert _refused(record, record.EXAMPLE) == ([], [])


def _refused(record: type[Record], text: str) -> tuple[list[str], list[str]]:
    """Return the errors of the schema and of the reader for the text of a record."""
    node, problems = parse(text, "example.yaml"), list[Problem]()
    rule = {"$ref": f"#/definitions/{record.definition()}", "definitions": DEFINITIONS}
    reader = Reader(node, record, "the example", problems)
    for key in record.keys().values():
        reader.get(key)
    messages = [error.message for error in Draft7Validator(rule).iter_errors(samples.plain(node))]
    return messages, [str(problem) for problem in problems]


@pytest.mark.parametrize("record", RECORDS, ids=_name)
def test_unknown_key_or_word_is_rejected_by_schema_and_reader(record: type[Record]) -> None:
    for errors in _refused(record, "zz_unknown: 1"):
        assert any("zz_unknown" in text for text in errors)
    for key in record.keys().values():
        if isinstance(key.shape, Word):
            for errors in _refused(record, f"{key.name}: zzz"):
                assert any("zzz" in text for text in errors), key.name


@pytest.mark.parametrize("record", RECORDS, ids=_name)
def test_page_describes_every_record_and_key(record: type[Record]) -> None:
    _, _, after = language_page().partition(f"\n### {record.heading()}\n")
    section = re.split(r"\n##", after)[0]
    assert record.description() in section
    for name, key in record.keys().items():
        assert f"| `{name}`" in section
        assert key.doc in section


def test_each_link_of_the_page_leads_to_one_of_its_headings() -> None:
    page = language_page()
    headings = {
        line.lstrip("# ").lower().replace(" ", "-")
        for line in page.splitlines()
        if line.startswith("#")
    }
    links = set(re.findall(r"\]\(#([^)]*)\)", page))
    assert links
    assert links <= headings


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        *[("01", "01"), ("0055", "00 55"), ("4E10", "4E 10"), ("FE FE", "FE FE"), ('"C0"', "C0")],
        *[("0x55", None), ("1_2", None), ("-55", None), ("5.5", None), ("", None)],
    ],
)
def test_bytes_are_read_as_they_are_written_although_yaml_reads_some_as_numbers(
    text: str, expected: str | None
) -> None:
    problems: list[Problem] = []
    reader = Reader(parse(f"footer: {text}", "a.yaml"), language.Frame, "the frame", problems)
    known = len(problems)
    found = reader.get(language.Frame.footer)
    assert found == (expected if expected is None else bytes.fromhex(expected))
    assert [problem.code for problem in problems[known:]] == ["bad-hex"] * (expected is None)


@pytest.mark.parametrize("limit", COMMAND_LIMITS, ids=lambda limit: limit.heading)
def test_command_that_the_language_cannot_state_is_refused_by_name(limit: Limit) -> None:
    for key in limit.keys:
        problems: list[Problem] = []
        Reader(parse(f"{key}: x", "a.yaml"), language.Command, "the command", problems)
        assert [p.message for p in problems if p.code == "cannot-say"] == [limit.message]
    assert f"### {limit.heading}\n" in language_page()


def test_command_without_an_id_is_refused_by_name() -> None:
    problems: list[Problem] = []
    Reader(parse("title: x", "a.yaml"), language.Command, "the command x", problems)
    assert f"the command x lacks the key id; {NO_COMMAND.message}" in {p.message for p in problems}


def _refusals(frame: dict[str, Any]) -> list[str]:
    """Return the code of each problem of a frame format, with the limit that it names."""
    try:
        in_format({key: value for key, value in (USUAL | frame).items() if value is not None})
    except SpecError as error:
        named = {limit.message: limit.heading for limit in LIMITS}
        found = [(problem.code, problem.message) for problem in error.problems]
        return [
            f"{code}: {next((named[m] for m in named if m in text), text)}" for code, text in found
        ]
    return []


# What authors write for well-known protocols, mostly in the words of their documents.
USUAL = {
    "header": "FF FF",
    "length_counts": ["command", "data", "check"],
    "check": "sum",
    "maximum_data": 40,
    "doc": "A frame.",
}
DELIMITED = {"check": "footer", "length_counts": ["command", "data"]}
OWN = {"value": 1, "doc": "A device."}
SILENT = {"value": 254, "doc": "All devices.", "replies": "none"}
SILENT_FIRST = (
    "bad-frame: the first address, ALL, is the default, but has no replies; list another one first"
)
STUFFED, NO_LENGTH = "cannot-say: Byte stuffing", "A protocol without a length"


@pytest.mark.parametrize(
    ("frame", "refused"),
    [
        ({}, []),
        ({"header": "FF FF FD 00"}, [STUFFED]),  # Dynamixel 2.0
        ({"header": "FF FF FD 00", "byte_stuffing": True}, [STUFFED]),
        ({"header": "FF FF FD 00", "stuffing": False}, []),
        ({"stuffing": True}, [STUFFED]),
        ({**DELIMITED, "header": "C0", "footer": "C0"}, [STUFFED]),  # SLIP
        ({**DELIMITED, "header": "7E", "footer": "7E", "stuffing": False}, []),
        ({**DELIMITED, "header": "7E", "footer": "7F"}, []),
        ({**DELIMITED, "header": "00", "footer": "00", "cobs": True}, [STUFFED]),
        ({"encoding": "hex"}, ["cannot-say: Bytes in another encoding"]),  # Modbus ASCII
        ({"addresses": {"ALL": SILENT}}, []),
        ({"addresses": {"A": OWN, "ALL": SILENT}}, []),
        ({"addresses": {"ALL": SILENT, "A": OWN}}, [SILENT_FIRST]),
        ({"header": "24 4D 3C"}, ["cannot-say: A header for each direction"]),  # MSP
        ({"header": "24 4D", "direction": {}}, ["cannot-say: A header for each direction"]),
        ({"header": "24 58 3C 00"}, ["cannot-say: Further bytes before the data"]),
        (
            {"header": "24 58", "address_range": [0x3C, 0x3E]},
            ["cannot-say: Further bytes before the data"],
        ),
        (  # Modbus RTU
            {"header": None, "length_counts": None, "layout": ["command"]},
            ["missing-key: A protocol without a header", f"missing-key: {NO_LENGTH}"],
        ),
        ({"header": "01", "layout": ["command"]}, [f"cannot-say: {NO_LENGTH}"]),
        (
            {"header": "", "length_counts": []},
            ["cannot-say: A protocol without a header", f"cannot-say: {NO_LENGTH}"],
        ),
        (  # TFmini
            {"header": "59 59", "layout": []},
            ["cannot-say: A protocol without a command id", f"cannot-say: {NO_LENGTH}"],
        ),
        (  # MAVLink
            {"layout": ["length", "sequence", "command"]},
            ["cannot-say: Further bytes before the data"],
        ),
        (
            {"check": "crc-16/umts"},
            [
                "unknown-word: check of the frame cannot be crc-16/umts; did you mean crc16-umts "
                "(FEE8)? In parentheses is the CRC of the ASCII digits 123456789"
            ],
        ),
        (
            {"replies_have_command": False, "check_from": "data", "length_counts": ["data"]},
            [
                "bad-frame: check_from cannot be data, since the data of replies start earlier",
                "bad-frame: length_counts must have command, since replies have data in its place",
            ],
        ),
    ],
)
def test_frame_that_the_language_cannot_state_is_refused_by_name(
    frame: dict[str, Any], refused: list[str]
) -> None:
    assert _refusals(frame) == refused


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ("crc16-ccitt-false", ["crc16-ibm-3740"]),
        ("crc16-x25", ["crc16-ibm-sdlc"]),
        ("CRC-32", ["crc32-iso-hdlc"]),
        ("crc8", ["crc8-smbus"]),
        ("CRC-CCITT", ["crc16-kermit", "crc16-ibm-3740", "crc16-xmodem"]),
        ("crc16", ["crc16-arc", "crc16-modbus", "crc16-kermit", "crc16-ibm-3740", "crc16-xmodem"]),
        ("crc16-modbsu", []),
        ("crc32-mpg", []),
        ("summ", ["sum"]),
    ],
)
def test_only_crcs_that_have_the_given_name_elsewhere_are_suggested(
    given: str, named: list[str]
) -> None:
    [text] = _refusals({"check": given})
    hint = text.partition("; ")[2].partition("? ")[0]
    suggested = re.findall(r"[\w-]+", re.sub(r" \(\w+\)|did you mean| or ", " ", hint))
    assert (suggested if "did you mean" in text else []) == named
    assert named or "compare the CRC of the ASCII digits 123456789" in text


def test_page_lists_the_crcs_with_their_check_values() -> None:
    assert "Greg Cook's catalogue" in language_page()
    assert "`crc16-ibm-3740` 29B1, " in language_page()
