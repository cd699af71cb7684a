"""Record with ``call --record``, and decode the recording with times and directions."""

from __future__ import annotations

import gzip
import json
from pathlib import Path

import pytest

from capture.lines import written
from cobotwire.capture import Packet, read
from cobotwire.simulator import PtyServer, SimulatedArm
from in_process import cobotwire as run
from scripted_peer import ScriptedPeer

QUERY = bytes.fromhex("FE FE 02 20 FA")
ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
LEAK = bytes.fromhex("FF FF 01 04 02 38 02 BE")


@pytest.fixture
def recorded(tmp_path: Path) -> Path:
    """Record a call on a bad line: an echo, a servo leak, and a reply with a pause inside."""
    path = tmp_path / "arm.pcapng"
    with ScriptedPeer([QUERY, LEAK + ANGLES[:8], 0.1, ANGLES[8:]]) as peer:
        result = run("call", peer.url, "get_angles", "--record", path)
    assert (result.returncode, result.stderr) == (0, f"wrote {path}\n")
    return path


def test_decode_prints_times_and_directions_of_a_recording(recorded: Path) -> None:
    result = run("decode", recorded)
    assert (result.returncode, result.stderr) == (1, "")
    request, echo, leak, reply = (line.split() for line in result.stdout.splitlines())
    assert request[:4] == ["0.000000", ">", "0", "frame"]
    assert " ".join(request[9:]) == "request: get_angles()"
    assert echo[1:4] == ["<", "0", "opposite-frame"]
    assert " ".join(echo[9:]) == "echo of our request get_angles"
    assert leak[1:4] == ["<", "5", "servo"]
    assert reply[1:4] == ["<", "13", "frame"]
    assert "reply:" in reply
    assert "request:" not in reply
    assert 0 <= float(echo[0]) <= float(leak[0]) <= float(reply[0]) < 10


def test_json_output_holds_times_and_directions(recorded: Path) -> None:
    entries = [*map(json.loads, run("decode", recorded, "--json").stdout.splitlines())]
    (summary,) = map(json.loads, run("decode", recorded, "--json", "--summary").stdout.splitlines())
    packets = list(read(recorded))
    assert entries[0]["time_ns"] == packets[0].time_ns
    assert [entry["direction"] for entry in entries] == ["sent", "received", "received", "received"]
    assert [entry["kind"] for entry in entries] == ["frame", "noise", "noise", "frame"]
    assert entries[2]["finding"] == "servo"
    assert [reading["command"] for reading in entries[3]["readings"]] == ["get_angles"]
    assert summary["bytes"] == sum(len(packet.data) for packet in packets)
    assert sum(summary["noise"].values()) == len(QUERY + LEAK)


def test_truncated_recording_is_decoded_with_a_warning(recorded: Path, tmp_path: Path) -> None:
    whole = recorded.read_bytes()
    cut = tmp_path / "cut.pcapng"
    cut.write_bytes(whole[: whole.rindex(ANGLES[:8]) + 12])
    result = run("decode", cut)
    assert result.returncode == 1
    assert "ends in the middle of a packet" in result.stderr
    assert "request: get_angles()" in result.stdout


@pytest.mark.parametrize("kind", ["bin", "pcapng"])
def test_cut_compressed_file_is_decoded_and_reported(tmp_path: Path, kind: str) -> None:
    path = tmp_path / f"arm.{kind}.gz"
    data = written([Packet(0, "received", ANGLES)]) if kind == "pcapng" else ANGLES
    path.write_bytes(gzip.compress(data)[:-3])
    result = run("decode", path)
    assert result.returncode == 1
    assert result.stderr == f"cobotwire: {path} has compressed data that is cut off\n"
    assert "get_angles(angles=(1.4," in result.stdout
    if kind == "pcapng":
        info = run("capture", "info", path)
        assert (info.returncode, "it has compressed data that" in info.stdout) == (1, True)


def test_direction_option_applies_to_packets_of_unknown_direction(tmp_path: Path) -> None:
    path = tmp_path / "other.pcapng"
    parts = (ANGLES[:5], ANGLES[5:])
    path.write_bytes(written(Packet(n, "unknown", part, "bytes") for n, part in enumerate(parts)))
    result = run("decode", path, "--direction", "reply")
    assert result.returncode == 0
    assert result.stdout.split()[:4] == ["0.000000", "?", "0", "frame"]


def test_existing_file_is_not_overwritten_and_nothing_is_sent(
    server: PtyServer, simulated: SimulatedArm, tmp_path: Path
) -> None:
    path = tmp_path / "there.pcapng"
    path.write_bytes(b"precious")
    result = run("call", server.url, "power_on", "--record", path)
    assert result.returncode == 2
    assert "the file exists already" in result.stderr
    assert path.read_bytes() == b"precious"
    assert not simulated.state.powered


def test_times_count_from_the_first_packet_even_if_it_is_at_0_ns(tmp_path: Path) -> None:
    path = tmp_path / "arm.pcapng"
    path.write_bytes(written([Packet(0, "sent", QUERY), Packet(1_500_000_000, "received", ANGLES)]))
    result = run("decode", path)
    assert [line.split()[0] for line in result.stdout.splitlines()] == ["0.000000", "1.500000"]
