"""A hostile file or peer causes normal output or a plain error, never a traceback."""

from __future__ import annotations

import struct
import subprocess
import sys
from itertools import cycle
from pathlib import Path

import pytest

from capture.lines import written
from cobotwire import MyCobot
from cobotwire import codec as codecs
from cobotwire.capture import Packet, Piece, read
from cobotwire.capture import block_encoding as blocks
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.errors import ScenarioError
from cobotwire.simulator import PtyServer, ReplayedArm
from cobotwire.simulator.faults import load
from in_process import cobotwire

SECOND = 10**9
REQUEST = bytes.fromhex("FE FE 02 20 FA")
ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
DIGITS = "9" * 5000
PANIC = f"Guru Meditation Error: Core  {DIGITS} panic'ed (LoadProhibited). \r\nRebooting...\r\n"


def run(*words: str | Path) -> tuple[int, str]:
    """Run the CLI in this process; return its exit code and output. A traceback is raised."""
    done = cobotwire(*words)
    return done.returncode, done.stdout + done.stderr


def write(path: Path, *comments: str, options: list[tuple[int, bytes]] | None = None) -> Path:
    """Write a recording of a frame for each comment, on an interface with options."""
    interface = struct.pack("<HHI", blocks.LINK_TYPE, 0, 0) + blocks._options(options or [])
    packets = (blocks.packet(0, SECOND, ANGLES, blocks.INBOUND, comment) for comment in comments)
    parts = blocks.section("cobotwire"), blocks._block(blocks.INTERFACE, interface), *packets
    path.write_bytes(b"".join(parts))
    return path


SUBCOMMANDS = [["replay"], ["replay", "--json"], ["decode"], ["decode", "--json"], ["plot", "-o"]]


def show(subcommand: list[str], recording: Path) -> tuple[int, str]:
    """Run a subcommand on a recording."""
    output = [recording.with_suffix(".png")] if subcommand[0] == "plot" else []
    return run(*subcommand, *output, recording)


@pytest.mark.parametrize("subcommand", SUBCOMMANDS, ids=" ".join)
def test_number_with_thousands_of_digits_in_a_comment_changes_nothing(
    tmp_path: Path, subcommand: list[str]
) -> None:
    recording = write(
        tmp_path / "arm.pcapng",
        f"in pieces: {DIGITS} bytes at +0 ns",
        f"in pieces: 17 bytes at +{DIGITS} ns",
        f"in pieces: 17 bytes at +{'9' * 400} ns",  # beyond a float
        f"in pieces: {'0' * 5000}17 bytes at +1 ns",
    )
    code, _ = show(subcommand, recording)
    # The recording lacks its end marker; only decode reports this.
    assert code == (subcommand[0] == "decode")
    *others, last = (packet.pieces for packet in read(recording))
    assert others == [()] * 3
    assert last in ((), (Piece(17, SECOND + 1),))


@pytest.mark.parametrize("subcommand", SUBCOMMANDS, ids=" ".join)
@pytest.mark.parametrize("option", [blocks.INTERFACE_SPEED, blocks.INTERFACE_OFFSET])
def test_number_of_an_interface_with_thousands_of_bytes_is_damage(
    tmp_path: Path, subcommand: list[str], option: int
) -> None:
    path = write(tmp_path / "arm.pcapng", "", options=[(option, b"\x7f" * 5000)])
    code, text = show(subcommand, path)
    assert code == 6
    assert "a number of an interface is too long" in text


@pytest.mark.parametrize(
    "seconds", [(10, 9, 8, 7), (10, 11, 2, 3), (5, 5, 5, 5), (0, 2**34)], ids=str
)
@pytest.mark.parametrize("subcommand", [*SUBCOMMANDS, ["plot", "--pose", "-o"]], ids=" ".join)
def test_times_that_run_backwards_are_shown(
    tmp_path: Path, seconds: tuple[int, ...], subcommand: list[str]
) -> None:
    path = tmp_path / "arm.pcapng"
    ends = Packet(0, "sent", REQUEST), Packet(0, "received", ANGLES)
    packets = (each._replace(time_ns=at * SECOND) for each, at in zip(cycle(ends), seconds))
    path.write_bytes(written(packets))
    assert show(subcommand, path)[0] == 0
    if subcommand == ["plot", "-o"]:
        assert path.with_suffix(".png").stat().st_size > 1000


def test_recorded_pause_of_centuries_does_not_end_the_server() -> None:
    packets = [Packet(0, "sent", REQUEST), Packet(2**63, "received", ANGLES)]
    with PtyServer(ReplayedArm(packets, codecs.load(TABLE))) as server:
        for _ in range(2):
            with MyCobot(server.url, timeout=0.2) as arm, pytest.raises(TimeoutError):
                arm.get_angles()
        assert server._thread.is_alive()


@pytest.mark.parametrize("words", [["--raw"], ["--raw", "--json"], ["--raw", "--summary"]])
def test_panic_with_a_core_of_thousands_of_digits_is_decoded(
    tmp_path: Path, words: list[str]
) -> None:
    file = tmp_path / "arm.bin"
    file.write_bytes(PANIC.encode())
    code, text = run("decode", file, *words)
    assert code == 1
    assert "LoadProhibited" in text


@pytest.mark.parametrize("line", ["get_angles 'x", 'send_angle 1 "', "get_angles \\"])
def test_open_quote_in_expected_calls_names_its_line(tmp_path: Path, line: str) -> None:
    file = tmp_path / "calls.txt"
    file.write_text(f"get_angles\n{line}\n")
    code, text = run("conform", "client", "--expect", file)
    assert code == 2
    assert f"{file}:2: " in text


def test_scenario_without_packets_names_its_line(tmp_path: Path) -> None:
    file = tmp_path / "leaks.yaml"
    file.write_text("faults:\n- {fault: servo-leak, packets: []}\n")
    with pytest.raises(ScenarioError) as caught:
        load(file)
    assert str(caught.value) == (
        f"{file}:2:32: packets is an empty list; allowed: at least one value"
    )


@pytest.mark.parametrize("value", [f"0x{'f' * 5000}", DIGITS, "9" * 400, "1e999", "nan"])
def test_argument_with_thousands_of_digits_is_wrong_usage(server: PtyServer, value: str) -> None:
    for words in (["send_angle", "1", value, "30"], ["get_encoder", value]):
        code, text = run("call", server.url, *words)
        assert code == 2
        assert len(text) < 300


def test_recording_that_cannot_be_started_leaves_no_file(server: PtyServer, tmp_path: Path) -> None:
    file = tmp_path / "arm.pcapng"
    call = ["call", server.url, "get_angles", "--record", str(file)]
    # No file may grow: each write fails, as on a full disk.
    limited = ["sh", "-c", 'ulimit -f 0; exec "$@"', "sh", sys.executable, "-c"]
    command = [*limited, "from cobotwire.cli import main; main()", *call]
    for _ in range(2):
        ended = subprocess.run(command, capture_output=True, text=True, check=False)
        assert (ended.returncode, ended.stdout) == (2, "")
        assert ended.stderr == f"cobotwire: {file}: File too large\n"
        # A leftover file would make the next attempt fail.
        assert not file.exists()
