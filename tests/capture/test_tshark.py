"""Exchange captures with Wireshark's own programs, in both directions."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from capture.lines import FRAMES, Chunk, written
from cobotwire import codec as codecs
from cobotwire.capture import Packet, Piece, Recording, read
from cobotwire.capture.block_encoding import LINK_TYPE
from cobotwire.editions.mycobot import TABLE

pytestmark = pytest.mark.skipif(
    not (shutil.which("tshark") and shutil.which("capinfos") and shutil.which("editcap")),
    reason="Wireshark's programs are not installed (Debian: apt install tshark)",
)

TEXT = b"Guru Meditation Error"
FIELDS = (
    "frame.time_epoch",
    "frame.packet_flags_direction",
    "frame.interface_name",
    "frame.interface_description",
    "frame.encap_type",
    "frame.comment",
    "data.data",
)


def run(*words: str | Path) -> str:
    return subprocess.run(
        [str(word) for word in words], capture_output=True, text=True, check=True
    ).stdout


def fields(path: Path) -> list[dict[str, str]]:
    """Return the fields that tshark shows of each packet."""
    wanted = [word for field in FIELDS for word in ("-e", field)]
    found = json.loads(run("tshark", "-r", path, "-T", "json", *wanted))
    return [
        {name: ",".join(values) for name, values in packet["_source"]["layers"].items()}
        for packet in found
    ]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """Record a request, its reply in two reads, and a panic."""
    path = tmp_path / "line.pcapng"
    with Recording(path, codecs.load(TABLE), url="/dev/ttyACM0", baudrate=115200) as recording:
        recording(Chunk(10.0, "sent", FRAMES[0]))
        recording(Chunk(10.01, "received", FRAMES[1][:8]))
        recording(Chunk(10.11, "received", FRAMES[1][8:] + TEXT))
    return path


def test_tshark_shows_frames_directions_and_comments(path: Path) -> None:
    request, reply, panic = fields(path)
    assert [bytes.fromhex(p["data.data"]) for p in (request, reply, panic)] == [
        FRAMES[0],
        FRAMES[1],
        TEXT,
    ]
    # 1 is inbound, 2 is outbound.
    directions = [int(p["frame.packet_flags_direction"], 0) for p in (request, reply, panic)]
    assert directions == [2, 1, 1]
    assert {p["frame.interface_name"] for p in (request, reply, panic)} == {"/dev/ttyACM0"}
    assert request["frame.interface_description"] == "edition mycobot"
    assert "frame.comment" not in request
    assert reply["frame.comment"] == "in pieces: 8 bytes at +0 ns, 9 bytes at +100000000 ns"
    assert panic["frame.comment"] == "noise no-header"


def test_tshark_shows_nanoseconds(path: Path) -> None:
    shown = [packet["frame.time_epoch"] for packet in fields(path)]
    stamps = [packet.time_ns for packet in read(path)]
    assert [int(text.replace(".", "")) for text in shown] == stamps


def test_capinfos_reads_the_header(path: Path) -> None:
    output = run("capinfos", path)
    assert "Wireshark/... - pcapng" in output
    assert "Number of packets:   3" in output
    assert "Capture application: cobotwire" in output
    assert "Time precision = nanoseconds (9)" in output
    assert f"USER {LINK_TYPE - 147}" in output
    assert "Speed = 115200" in output


def test_tshark_shows_several_interfaces(tmp_path: Path) -> None:
    path = tmp_path / "two.pcapng"
    packets = [Packet(10**18 + n, "sent", b"x", interface=n % 2) for n in range(4)]
    path.write_bytes(written(packets, "/dev/ttyUSB0", "socket://arm:9000"))
    names = [packet["frame.interface_name"] for packet in fields(path)]
    assert names == ["/dev/ttyUSB0", "socket://arm:9000"] * 2


def test_tshark_reads_a_truncated_capture_up_to_the_same_packet(path: Path) -> None:
    whole = path.read_bytes()
    ends_within_last = path.with_name("cut.pcapng")
    ends_within_last.write_bytes(whole[: whole.index(TEXT) + 3])
    result = subprocess.run(
        ["tshark", "-r", str(ends_within_last), "-T", "fields", "-e", "frame.number"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.stdout.split() == ["1", "2"]
    assert "cut short" in result.stderr
    assert len(list(read(ends_within_last))) == 2


def test_capture_rewritten_by_editcap_is_read_unchanged(path: Path) -> None:
    again = path.with_name("again.pcapng")
    run("editcap", path, again)
    theirs, ours = read(again), read(path)
    packets = list(ours)
    # editcap keeps the name of the application; the kinds of packets depend on it.
    assert list(theirs) == packets
    assert packets[1].pieces == (
        Piece(8, packets[1].time_ns),
        Piece(9, packets[1].time_ns + 100_000_000),
    )
    assert theirs.interfaces == ours.interfaces
