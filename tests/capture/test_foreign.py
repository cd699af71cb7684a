"""Read files of other programs (``written_by_others/README.md``), and report their mistakes."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire.capture import CaptureReader, read
from cobotwire.capture.block_file import BlockFile
from cobotwire.capture.foreign.recognising import FORMATS, Recognised, recognise
from cobotwire.cli.shared import input_files
from cobotwire.protocol.errors import CaptureError, EmptyInput, UnreadableInput

FILES = Path(__file__).parent / "written_by_others"
ASKED = bytes.fromhex("FE FE 02 20 FA")
MOVED = bytes.fromhex("FE FE 06 21 01 00 1D 14 FA")
ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
TALK = {"sent": ASKED + MOVED + ASKED, "received": ANGLES * 3}


def opened(data: bytes, format: str | None = None, ports: tuple[int, ...] = ()) -> Recognised:
    """Recognise a file from blocks of 61 bytes."""
    blocks = (data[at : at + 61] for at in range(0, len(data), 61))
    return recognise(blocks, "file", format, ports)


def capture_of(found: Recognised) -> CaptureReader:
    assert found.recording
    return CaptureReader(BlockFile(found.blocks, None, found), "file")


def directions(capture: CaptureReader) -> dict[str, bytes]:
    found: dict[str, bytes] = {}
    for packet in capture:
        found[packet.direction] = found.get(packet.direction, b"") + packet.data
    return found


@pytest.mark.parametrize(
    ("name", "format", "expected", "seconds"),
    [
        ("socat-x.txt", "socat", TALK, 0.046392),
        ("socat-x-v.txt", "socat", TALK, 0.044754),
        (
            "pymycobot.log",
            "pymycobot",
            {
                "sent": bytes.fromhex("FE FE 02 20 FA FE FE 02 12 FA FE FE 06 21 01 00 1C 14 FA"),
                "received": ANGLES + bytes.fromhex("FE FE 03 12 01 FA"),
            },
            0.024,
        ),
        ("candump.log", "candump", {"unknown": ASKED + ANGLES + ASKED}, 0.400291),
        ("candump-long.txt", "candump", {"unknown": ASKED + ANGLES + ASKED}, 0.400291),
        ("saleae-logic1.csv", "saleae", {"unknown": ANGLES}, 0.0013888),
        ("saleae-logic2.csv", "saleae", {"sent": ASKED, "received": ANGLES}, 0.0018228),
        ("pulseview.txt", "sigrok", {"sent": ASKED, "received": ANGLES}, None),
        ("sigrok-cli.txt", "sigrok", {"unknown": ANGLES[:10]}, None),
        ("ethernet.pcap", "pcap", TALK, 0.040587),
        ("sll.pcap", "pcap", TALK, 0.056405),
        ("sll2-ipv6.pcap", "pcap", TALK, 0.040650),
    ],
)
def test_file_of_another_program_is_read_with_times_and_directions(
    name: str, format: str, expected: dict[str, bytes], seconds: float | None
) -> None:
    found = opened((FILES / name).read_bytes())
    assert found.reader is not None
    assert found.reader.name == format
    capture = capture_of(found)
    packets = list(capture)
    assert capture.incomplete == ""
    assert capture.timed == (seconds is not None)
    assert packets[-1].time_ns - packets[0].time_ns == pytest.approx((seconds or 0) * 1e9, abs=1000)
    with read(FILES / name, format=format) as again:
        assert directions(again) == expected


@pytest.mark.parametrize(
    ("begin", "missing"),
    [
        (8, ""),
        (34, "lacks 26 bytes received before line 3; what follows is part 2"),
        (3, "repeats bytes received before line 3; what follows is part 2"),
        (0, ""),
    ],
)
def test_bytes_on_both_sides_of_a_gap_in_a_socat_dump_are_not_joined(
    begin: int, missing: str
) -> None:
    text = "".join(
        f"< 2026/11/24 14:00:00.000001  length={len(data)} from={at} to={at + len(data) - 1}\n"
        f" {data.hex(' ')}\n"
        for at, data in ((0, ANGLES[:8]), (begin, ANGLES[8:]))
    )
    capture = capture_of(opened(text.encode()))
    assert [packet.interface for packet in capture] == [0, int(bool(missing))]
    assert capture.incomplete == f"file {missing}" * bool(missing)


def test_times_without_a_date_are_marked_and_may_be_negative() -> None:
    rows = f"-1.5,0xFE,,\n-0.0000000000000000001,0xFE,,\n{0.0012000000000000001},0x02,,\n"
    capture = capture_of(opened(b"Time [s],Value,Parity Error,Framing Error\n" + rows.encode()))
    assert [packet.time_ns for packet in capture] == [-1_500_000_000, 0, 1_200_000]
    assert (capture.timed, capture.dated) == (True, False)
    dated = capture_of(opened((FILES / "socat-x.txt").read_bytes()))
    assert (list(dated) != [], dated.dated) == (True, True)


def test_empty_reads_of_pymycobot_are_counted() -> None:
    found = opened(b"_write: fe fe 02 20 fa\n_read : \n")
    assert b"".join(packet.data for packet in capture_of(found)) == ASKED
    assert found.file.notes == ["left out 1 line of file without bytes"]


def test_each_id_of_a_can_bus_is_a_stream() -> None:
    capture = capture_of(opened((FILES / "candump.log").read_bytes()))
    assert {packet.interface for packet in capture} == {0, 1}
    assert [each.url for each in capture.interfaces] == ["can0 123", "can0 124"]
    assert capture.foreign is not None
    assert capture.foreign.file.notes == ["left out 1 remote request, which have no data"]


DATA = ASKED + bytes(9000) + b"ab  " * 30 + b" |*| 61 62\n" + bytes(range(256)) + b"\xff" * 50


@pytest.mark.parametrize(
    "command",
    [
        *("xxd", "xxd -g1", "xxd -c 8 -u", "xxd -a", "xxd -p", "xxd -s 16", "hexdump -C"),
        *("hexdump -Cv", "od -A x -t x1z", "od -A x -t x1 -v"),
    ],
)
def test_dump_by_a_program_gives_its_bytes(command: str) -> None:
    program, *options = command.split()
    if not shutil.which(program):
        pytest.skip(f"{program} is not installed")
    dump = subprocess.run([program, *options], input=DATA, capture_output=True, check=True).stdout
    found = opened(dump)
    assert (found.recording, found.file.missing) == (False, [])
    assert b"".join(found.blocks) == DATA[16 if "-s" in options else 0 :]


@given(
    st.lists(
        st.tuples(st.binary(max_size=20), st.sampled_from([repr, list, bytearray, tuple])),
        min_size=1,
    ),
    st.sampled_from(["\n", " ", ", ", "\r\n"]),
)
def test_python_literals_give_their_bytes(parts: list[tuple[bytes, type]], gap: str) -> None:
    text = gap.join(str(show(data)) for data, show in parts).encode()
    assert b"".join(opened(text, "python").blocks) == b"".join(data for data, _ in parts)


def test_python_list_over_several_lines_is_read_as_one_list() -> None:
    found = opened(b"bytes([0xFE, 254,\n  2, 32,\n  250])\nb'\\xfe' b'\\x00\\t'\n")
    assert b"".join(found.blocks) == ASKED + b"\xfe\0\t"
    long = "[\n" + "254,\n" * 50_000 + "]\n"
    assert b"".join(opened(long.encode()).blocks) == b"\xfe" * 50_000


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("00000000: fefe 02  ...\n00000004: 21  !\n", "file:2: expected the offset 00000003"),
        ("00000000: fefe 02  ...\n00000003: zz  .\n", "file:2: expected a line of a dump by xxd"),
        ("00000000: 6162  ax\n", "file:1: expected 'ab' after the bytes"),
        ("00000000: 6162  ab\n*\n00000005: 61  a\n", "file:3: expected an offset after whole"),
        ("b'\\xfe'\nb'\\xzz'\n", "file:2: expected Python literals"),
        ("[254, 300]\n", "file:1: expected bytes from 0 to 255"),
        ("[254,\n", "file:1: expected the end of a list"),
        ("_write: fe fe\n_read : fe xyz\n", "file:2: expected bytes in hex after _read"),
        ("2026-11-24 14:00:00.000 _write: fe\n_read : fe\n", "file:2: expected a time"),
        ("can0 123#FE\ncan0 123#F\n", "file:2: expected a line of candump"),
        ("can0 123 [2] FE\n", "file:1: expected 2 bytes"),
        ("Time [s],Value,Parity Error,Framing Error\n0.1,'a',,\n", "file:2: expected a byte such"),
        ('name,type,start_time,duration,"data"\n"A","data",x,1,0xFE\n', "file:2: expected a time"),
        ("Time [s],Value\n0.1,0x\r1\n", "file:2: expected a row of a CSV file"),
        ("uart-1: FE\nuart-1: [0A]\n", "file:2: expected an annotation"),
        (
            "> 2026/11/24 14:00:00.000001  length=1 from=0 to=0\n fe fe\n",
            "file:2: expected 1 bytes after line 1",
        ),
        ("fe fe 02\nzz", "file is text, but not hex"),
    ],
)
def test_wrong_line_is_an_error_with_its_number(text: str, message: str) -> None:
    with pytest.raises(UnreadableInput) as caught:
        b"".join(opened(text.encode()).blocks)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize(
    ("start", "message"),
    [
        (b"PK\x03\x04" + bytes(26) + b"meta.json", "a project of Saleae Logic"),
        (b"PK\x03\x04" + bytes(26) + b"logic-1-1", "a session of sigrok"),
        (b"PK\x03\x04" + bytes(26) + b"a.txt", "an archive"),
        (b"SQLite format 3\0", "an SQLite database"),
        (b"LOGG\x90\0\0\0", "a CAN log in BLF"),
        ("fe fe 02 20 fa".encode("utf-16"), "UTF-16"),
        ((FILES / "socat-v.txt").read_bytes(), "socat -v"),
        (b"0000000 fefe 2002 00fa\n0000005\n", "16-bit words"),
        (b"0000000 177376 020002\n0000005\n", "in octal"),
        (b'{"data": [254, 254]}', "JSON"),
        (b"0000: FE FE 02 20 FA\n", "a dump with offsets"),
        (b"0010  FE FE 02\n0013  20 FA\n", "a dump with offsets"),
        (b"000000 fefe 2002 00fa\n000005\n", "a dump with offsets"),
        (b'"robot","source","offset","time"\n', "written by an export"),
        (b"time,id,bytes\n1,2,fe fe\n", "a CSV with 3 columns: time,id,bytes"),
        (b"12:30:01 motor started\n", "is text, but not hex nor another known format"),
    ],
)
def test_file_that_cannot_be_read_is_named(start: bytes, message: str) -> None:
    with pytest.raises(UnreadableInput) as caught:
        opened(start)
    assert message in str(caught.value)
    assert "--raw decodes it as raw bytes" in str(caught.value)
    assert b"".join(opened(start, "raw").blocks) == start


def test_file_that_two_readers_can_read_is_not_guessed() -> None:
    with pytest.raises(UnreadableInput, match="--read-as pymycobot or --read-as candump"):
        opened(b"can0 123#FE\n_write: fe\n")


def test_empty_file_is_an_error() -> None:
    with pytest.raises(EmptyInput, match="file is empty"):
        opened(b"")


starts = st.sampled_from([b"", *(path.read_bytes()[:300] for path in FILES.iterdir())])


@given(starts, st.integers(0, 300), st.binary(max_size=40), st.sampled_from([None, *FORMATS]))
def test_arbitrary_bytes_are_read_or_refused(
    start: bytes, cut: int, data: bytes, format: str | None
) -> None:
    try:
        found = opened(start[:cut] + data + start[cut + len(data) :], format)
        for _ in capture_of(found) if found.recording else found.blocks:
            pass
    except (UnreadableInput, CaptureError):
        pass


@pytest.mark.parametrize("name", ["xxd", "socat-x.txt", "ethernet.pcap"])
def test_file_is_read_while_its_bytes_are_used(name: str) -> None:
    left = 2000

    def blocks() -> Iterator[bytes]:
        nonlocal left
        data = b"" if name == "xxd" else (FILES / name).read_bytes()
        # A pcap file has one header.
        head = 24 if name.endswith(".pcap") else 0
        if head:
            yield data[:head]
        for number in range(2000):
            left -= 1
            yield data[head:] or b"".join(
                b"%08x: fefe 0220 fa  ... .\n" % (at * 5)
                for at in range(number * 100, number * 100 + 100)
            )

    found = recognise(blocks(), "file", "xxd" if name == "xxd" else None)
    assert next(found.blocks)
    assert left > 1800


def test_command_line_offers_the_formats_that_exist() -> None:
    assert input_files.FORMATS == FORMATS
