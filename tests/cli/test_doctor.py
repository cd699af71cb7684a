"""``cobotwire doctor`` as a process: on the simulated arm, and on lines that are ill."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest

from cobotwire.capture import read
from cobotwire.editions.mycobot import TABLE
from cobotwire.health.latency import latency_timer
from cobotwire.sim import PtyServer
from scripted_peer import ScriptedPeer, ScriptedTcpPeer, Step

COMMAND = [sys.executable, "-c", "from cobotwire.cli import main; main()", "doctor"]
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
STILL = bytes.fromhex("FE FE 03 2B 00 FA")
ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
COORDS = bytes.fromhex("FE FE 0E 23 01 BC FD A0 10 0D DC 66 FF 54 DE 21 FA")
HEALTHY: list[list[Step]] = [[POWERED], [STILL], [ANGLES], [COORDS], [ANGLES], [ANGLES]]
PANIC = (
    b"Guru Meditation Error: Core 1 panic'ed (LoadProhibited). Exception was unhandled.\r\n"
    b"Rebooting...\r\n" + bytes(277)
)
LEAK = bytes.fromhex("FF FF 01 04 02 38 02 BE")


def run(*words: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*COMMAND, *map(str, words)], capture_output=True, text=True, timeout=60, check=False
    )


def examined(scripts: list[list[Step]], *words: str) -> tuple[int, dict[str, Any]]:
    with ScriptedPeer(*scripts) as peer:
        result = run(peer.url, "--json", "--count", "2", "--timeout", "0.15", *words)
    assert result.stderr == ""
    return result.returncode, json.loads(result.stdout)


def kinds(report: dict[str, Any]) -> list[str]:
    return [complaint["kind"] for complaint in report["complaints"]]


def in_front(noise: bytes) -> list[list[Step]]:
    """A line on which noise comes before one of the answers."""
    return [*HEALTHY[:2], [noise, *HEALTHY[2]], *HEALTHY[3:]]


def test_a_healthy_arm_is_healthy_and_only_queries_were_sent() -> None:
    with ScriptedPeer(*HEALTHY) as peer:
        result = run(peer.url, "--count", "2")
        asked = peer.heard
    assert (result.returncode, result.stderr) == (0, "")
    assert "6 of 6 questions answered" in result.stdout
    assert "round trip" in result.stdout
    assert result.stdout.endswith("healthy\n")
    sent = {asked[place + 3] for place in range(0, len(asked), 5)}
    by_id = {command.id: command.safety for command in TABLE.commands if command.id in sent}
    assert set(by_id.values()) == {"query"}


def test_the_simulated_arm_has_no_power_and_is_not_ill(server: PtyServer) -> None:
    result = run(server.url)
    assert result.returncode == 0
    assert "no-power: the arm has no power" in result.stdout
    assert not server.arm.state.powered


@pytest.mark.parametrize(
    ("noise", "kind", "said"),
    [
        (PANIC, "panic", "the controller rebooted: panic LoadProhibited"),
        (LEAK, "servo", "servo bus leak"),
        (b"cmd_len error\r\n", "cmd-len-error", "the firmware said cmd_len error"),
        (bytes.fromhex("78 80 78 80 78 80 F8 00 78 78 80 80"), "garbage", "another baud rate"),
    ],
)
def test_noise_is_diagnosed_and_advice_is_given(noise: bytes, kind: str, said: str) -> None:
    code, report = examined(in_front(noise))
    assert code == 1
    assert kind in kinds(report)
    assert said in report["diagnosis"]
    assert report["answered"] == report["asked"] == 6
    assert report["noise"] == len(noise)
    assert all(complaint["advice"] for complaint in report["complaints"])


def test_silence_is_told_soon_and_nothing_more_is_asked() -> None:
    started = time.monotonic()
    code, report = examined([])
    assert (code, kinds(report)) == (1, ["silence"])
    assert (report["asked"], report["answered"], report["healthy"]) == (3, 0, False)
    assert time.monotonic() - started < 20


def test_a_lost_and_an_illegal_reply_are_told() -> None:
    illegal = bytes.fromhex("FE FE 03 2B 07 FA")
    code, report = examined([[], [illegal], *HEALTHY[2:]])
    assert code == 1
    assert kinds(report) == ["illegal-reply", "lost-replies"]
    assert report["complaints"][1]["says"].startswith("1 of 6")


def test_without_a_link_the_code_is_3_and_what_was_found_is_told() -> None:
    result = run("/dev/nosuchport", "--json")
    assert result.returncode == 3
    assert kinds(json.loads(result.stdout)) == ["link"]
    code, report = examined([HEALTHY[0], HEALTHY[1], [LEAK, 0.1, None]])
    assert code == 3
    assert kinds(report)[0] == "link"
    assert "servo" in kinds(report)
    assert report["answered"] == 2


def test_it_works_over_tcp_and_records(tmp_path: Path) -> None:
    path = tmp_path / "doctor.pcapng"
    with ScriptedTcpPeer(*HEALTHY) as peer:
        result = run(peer.url, "--count", "2", "--record", path)
    assert result.returncode == 0, result.stdout
    capture = read(path)
    assert [packet.direction for packet in capture] == ["sent", "heard"] * 6
    assert capture.finished


def test_noise_on_a_quiet_line_is_heard_before_anything_is_asked() -> None:
    with ScriptedPeer(*HEALTHY) as peer:
        telling = threading.Event()

        def tell() -> None:
            while not telling.wait(0.05) and not peer.heard:
                peer.say(LEAK)

        thread = threading.Thread(target=tell)
        thread.start()
        result = run(peer.url, "--count", "2")
        telling.set()
        thread.join()
    assert result.returncode == 1
    assert "servo bus leak" in result.stdout


def test_the_latency_timer_is_read_where_the_system_tells_it(tmp_path: Path) -> None:
    folder = tmp_path / "class" / "tty" / "ttyUSB7" / "device"
    folder.mkdir(parents=True)
    (folder / "latency_timer").write_text("16\n")
    assert latency_timer("/dev/ttyUSB7", tmp_path) == (16, folder / "latency_timer")
    assert latency_timer("/dev/ttyACM0", tmp_path) is None
    assert latency_timer("socket://ttyUSB7:1", tmp_path) is None
