"""Run ``cobotwire decode`` on files and pipes."""

from __future__ import annotations

import fcntl
import json
import os
import pty
import signal
import struct
import subprocess
import sys
import termios
import time
from pathlib import Path

import pytest

from decoding import COMMAND, FIELD, capture_in, run
from diagnosing import ANGLES, FRAME

KINDS = ["frame", "servo", "frame", "cmd-len-error", "panic", "nuls", "frame", "unrecognised"]


@pytest.fixture
def capture(tmp_path: Path) -> str:
    return capture_in(tmp_path)


def test_decode_prints_a_line_for_each_frame_and_finding(capture: str) -> None:
    code, out, err = run(capture)
    assert (code, err) == (1, "")
    lines = out.splitlines()
    kinds = [line.split()[1] for line in lines]
    assert kinds == KINDS
    assert "get_angles(angles=(0.01, 5.15" in lines[2]
    assert lines[1].startswith("       6  servo           FF FF 01 04 02 38 02 BE  servo bus: read")
    assert "panic LoadProhibited on core 1 at 0x400d15f4, backtrace of 3, rebooting" in out
    assert "\x1b[" not in out


def test_json_output_holds_every_byte_once(capture: str) -> None:
    _, out, _ = run(capture, "--json")
    events = [json.loads(line) for line in out.splitlines()]
    assert b"".join(bytes.fromhex(event["data"]) for event in events) == FIELD
    servo = events[1]
    assert (servo["kind"], servo["finding"], servo["offset"]) == ("noise", "servo", 6)
    assert servo["facts"]["register_name"] == "present position"
    assert servo["pieces"] == [[6, 8]]
    assert events[0]["readings"][0]["command"] == "is_power_on"


def test_exit_code_is_1_if_a_byte_is_not_in_a_legal_frame(tmp_path: Path) -> None:
    path = tmp_path / "clean.bin"
    path.write_bytes(ANGLES * 3)
    assert run(str(path))[0] == 0
    assert run(str(path), "--direction", "request")[0] == 1


def test_direction_and_accept_unknown_choose_what_is_a_frame(tmp_path: Path) -> None:
    path = tmp_path / "some.bin"
    path.write_bytes(bytes.fromhex("FE FE 02 20 FA FE FE 04 E0 01 02 FA"))
    assert "a request, get_angles: an echo" in run(str(path), "--direction", "reply")[1]
    assert "unlisted-frame" in run(str(path))[1]
    accepted = run(str(path), "--accept-unknown")[1].splitlines()
    assert [line.split()[1] for line in accepted] == ["frame", "frame"]


def test_bytes_option_explains_each_byte_of_a_file(capture: str) -> None:
    _, out, _ = run(capture, "--bytes")
    assert "LEN            14: 14 bytes follow" in out
    assert "noise   FF FF 01 04 02 38 02 BE   no-header\n  servo bus: read 2 bytes" in out


def test_summary_counts_frames_noise_and_findings(capture: str) -> None:
    code, out, _ = run(capture, "--summary", "--json")
    assert (code, out) == run(capture, "--quiet", "--summary", "--json")[:2]
    counts = json.loads(out)
    noise = len(FIELD) - len(ANGLES) - 2 * len(FRAME)
    assert code == 1
    assert counts["bytes"] == len(FIELD)
    assert counts["frames"] == {"0x12 is_power_on": 2, "0x20 get_angles": 1}
    assert counts["noise"] == {"no-header": noise}
    assert counts["findings"] == dict.fromkeys(
        ["servo", "cmd-len-error", "panic", "nuls", "unrecognised"], 1
    )
    assert counts["resyncs"] == 2
    assert counts["diagnosis"].startswith("the controller rebooted: panic LoadProhibited; ")
    _, words, _ = run(capture, "--summary")
    assert len(words.splitlines()) > 8
    assert words.startswith(f"{len(FIELD)} bytes, 3 frames, 2 resyncs")
    assert "get_angles(" not in words


def test_colours_distinguish_the_parts_of_a_frame(capture: str) -> None:
    shown = _on_a_terminal([*COMMAND, capture], None)
    assert "\x1b[2mFE FE 03\x1b[0m \x1b[36m\x1b[1m12\x1b[0m 01 \x1b[2mFA\x1b[0m" in shown
    assert "\x1b[33mFF FF 01 04 02 38 02 BE\x1b[0m" in shown
    words = _on_a_terminal([*COMMAND, "FE FE 03 12 00 FA 78"], None)
    assert "\x1b[36m\x1b[1m12\x1b[0m 00 \x1b[2mFA\x1b[0m" in words
    assert "noise   \x1b[31m78\x1b[0m" in words
    assert "\x1b[" not in run("FE FE 03 12 00 FA 78")[1]


def test_closed_output_ends_decode_with_141_and_no_message(tmp_path: Path) -> None:
    path = tmp_path / "long.bin"
    path.write_bytes(FIELD * 2000)
    process = subprocess.Popen(
        [*COMMAND, str(path)], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert process.stdout is not None
    assert process.stderr is not None
    assert process.stdout.readline()
    process.stdout.close()
    assert process.wait(timeout=60) == 141
    assert process.stderr.read() == b""
    process.stderr.close()


@pytest.mark.parametrize("words", [[], ["--summary"]], ids=["frames", "summary"])
def test_ctrl_c_ends_live_input_and_prints_the_counts_so_far(words: list[str]) -> None:
    process = subprocess.Popen(
        [*COMMAND, "-", *words],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.write(ANGLES * 2)
    process.stdin.flush()
    if words:
        _wait_until_read(process.stdin.fileno())
    else:
        # Live input is shown as it arrives, although the pipe stays open.
        assert b"get_angles" in process.stdout.readline()
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert (b"34 bytes, 2 frames, 0 resyncs" in out) == bool(words)
    assert b"Traceback" not in err


def _wait_until_read(pipe: int) -> None:
    """Wait until the other end has read everything, and has had the time to decode it."""
    end = time.monotonic() + 30
    while struct.unpack("i", fcntl.ioctl(pipe, termios.FIONREAD, bytes(4)))[0]:
        assert time.monotonic() < end
        time.sleep(0.05)
    time.sleep(1.0)


@pytest.mark.parametrize("option", [[], ["--summary"]], ids=["lines", "summary"])
def test_memory_use_does_not_depend_on_the_file_size(tmp_path: Path, option: list[str]) -> None:
    peaks = []
    for times in (1, 40):
        path = tmp_path / f"{times}.bin"
        with path.open("wb") as file:
            file.write((FIELD * 80 + b"~" * 5000) * times)
            # A sparse file: NULs that take no space on the disk.
            file.truncate(file.tell() + times * 500_000)
        script = (
            "import sys\n"
            "from cobotwire.cli import main\n"
            "try: main()\n"
            "except SystemExit: pass\n"
            # ru_maxrss would count the memory of pytest, from which this process was started.
            "status = dict(line.split(':') for line in open('/proc/self/status'))\n"
            "print(status['VmHWM'].removesuffix('kB\\n'), file=sys.stderr)"
        )
        command = [sys.executable, "-c", script, "decode", str(path), *option]
        with subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        ) as process:
            assert process.stderr is not None
            peaks.append(int(process.stderr.read()))
    small, large = peaks
    # KiB; the files have 0.6 and 23 MB.
    assert large < small + 6_000


def _on_a_terminal(command: list[str], stdout: int | None) -> str:
    """Return what a command writes to a terminal; ``stdout`` None includes its output."""
    master, slave = pty.openpty()
    with subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=slave if stdout is None else stdout,
        stderr=slave,
        env={**os.environ, "TERM": "xterm", "COLUMNS": "80"},
    ):
        os.close(slave)
        output = b""
        try:
            while block := os.read(master, 4096):
                output += block
        except OSError:
            pass  # reading from a pty fails when the other side is closed
        os.close(master)
    return output.decode()


def test_terminal_gets_colour_and_a_progress_bar_for_long_files(
    tmp_path: Path, capture: str
) -> None:
    path = tmp_path / "long.bin"
    with path.open("wb") as file:
        file.truncate(8_000_000)
    assert "\x1b[32mframe" in _on_a_terminal([*COMMAND, capture], None)
    assert "decoding" in _on_a_terminal([*COMMAND, str(path)], subprocess.DEVNULL)
    assert "decoding" not in _on_a_terminal([*COMMAND, capture], subprocess.DEVNULL)
