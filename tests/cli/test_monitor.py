"""Run ``cobotwire monitor``: lines, JSON, a table on a terminal, and how it ends."""

from __future__ import annotations

import json
import signal
import subprocess
from functools import partial
from pathlib import Path

import pytest

from cobotwire import MyCobot, editions
from cobotwire.capture import read
from cobotwire.editions.mycobot import TABLE
from cobotwire.inspect.monitor import ROLES
from cobotwire.simulator import PtyServer
from command_line import PROGRAM
from in_process import cobotwire
from scripted_peer import ScriptedPeer
from terminal import Terminal

COMMAND = [*PROGRAM, "monitor"]
run = partial(cobotwire, "monitor")
ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
COORDS = bytes.fromhex("FE FE 0E 23 00 00 00 00 00 00 00 00 00 00 00 00 FA")
REQUEST_SIZE = len(bytes.fromhex("FE FE 02 20 FA"))
LEAK = bytes.fromhex("FF FF 01 04 02 38 02 BE")


def test_monitor_prints_lines_without_a_terminal(server: PtyServer) -> None:
    result = run(server.url, "--count", "3", "--rate", "50")
    assert (result.returncode, result.stderr) == (0, "")
    lines = result.stdout.splitlines()
    assert len(lines) == 3
    assert all("get_angles" in line and "get_coords" in line for line in lines)
    assert "\x1b" not in result.stdout


def test_edition_without_joints_has_nothing_to_monitor(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "arm.pcapng"
    kept = tuple(each for each in TABLE.commands if each.role not in ROLES)
    monkeypatch.setattr(editions.load("mycobot"), "TABLE", TABLE._replace(commands=kept))
    result = cobotwire("--edition", "mycobot", "monitor", "memory://none", "--record", path)
    assert result.returncode == 2
    assert "nothing to monitor: mycobot has no query of joints or coordinates" in result.stderr
    assert not path.exists()


def test_json_output_holds_values_errors_and_noise() -> None:
    with ScriptedPeer([LEAK + ANGLES]) as peer:
        result = run(peer.url, "--count", "2", "--json")
    first, second = map(json.loads, result.stdout.splitlines())
    assert first["values"]["get_angles"]["j1"] == 1.4
    assert first["values"]["get_coords"] is None
    # A query without a reply is sent three times; only the very first request gets a reply.
    assert [(s["sent"], s["unanswered"]) for s in (first, second)] == [(4, 3), (10, 9)]
    assert first["noise"] == len(LEAK)
    assert first["diagnosis"].startswith("servo bus leak")
    assert "no reply to" in second["error"]


def test_requests_that_were_repeated_are_counted_as_unanswered() -> None:
    # The peer replies to every second request.
    with ScriptedPeer([], [ANGLES], [], [COORDS]) as peer:
        result = run(peer.url, "--count", "1", "--json")
    (sample,) = map(json.loads, result.stdout.splitlines())
    assert None not in sample["values"].values()
    assert len(peer.received) == 4 * REQUEST_SIZE
    assert (sample["sent"], sample["unanswered"], sample["late"]) == (4, 2, 0)


def test_reply_after_the_repeat_of_its_request_is_counted_as_late() -> None:
    with ScriptedPeer([], [ANGLES + ANGLES], [COORDS]) as peer:
        result = run(peer.url, "--count", "2", "--json")
    first = json.loads(result.stdout.splitlines()[0])
    assert (first["sent"], first["unanswered"], first["late"]) == (3, 1, 1)


def test_monitor_prints_the_counts_of_requests() -> None:
    with ScriptedPeer([], [ANGLES], [COORDS]) as peer:
        result = run(peer.url, "--count", "1")
    assert "3 sent, 1 unanswered, 0 late" in result.stdout


def test_monitor_keeps_the_rate(server: PtyServer) -> None:
    result = run(server.url, "--count", "11", "--rate", "20", "--json")
    samples = [json.loads(line) for line in result.stdout.splitlines()]
    assert samples[-1]["time"] >= 0.5 - 0.05
    assert samples[-1]["rate"] <= 21
    assert run(server.url, "--rate", "0").returncode == 2


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 0), (signal.SIGTERM, 143)])
def test_signal_closes_the_port_and_finishes_the_recording(
    server: PtyServer, tmp_path: Path, number: signal.Signals, code: int
) -> None:
    path = tmp_path / "watched.pcapng"
    process = subprocess.Popen(
        [*COMMAND, server.url, "--rate", "100", "--record", str(path)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        # If the tests run in the background, SIGINT is ignored, and child processes inherit that.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    assert process.stdout is not None
    for _ in range(5):
        assert b"get_angles" in process.stdout.readline()
    process.send_signal(number)
    _, error = process.communicate(timeout=30)
    assert (process.returncode, error.decode()) == (code, f"wrote {path}\n")
    capture = read(path)
    assert len(list(capture)) >= 10
    assert capture.finished
    with MyCobot(server.url) as arm:
        assert arm.is_power_on() is False


def test_lost_port_ends_monitor_with_its_exit_code() -> None:
    with ScriptedPeer([ANGLES, None]) as peer:
        result = run(peer.url)
    assert result.returncode == 3
    assert "Traceback" not in result.stderr


def test_ctrl_c_leaves_one_whole_table_on_a_terminal(server: PtyServer) -> None:
    with Terminal("monitor", server.url, columns=80, lines=24) as terminal:
        terminal.until(lambda: "└" in terminal.text())
        terminal.press(b"\x03")
        assert terminal.finish() == 0
        rows = [row for row in terminal.rows() if row]
    assert (server.url in rows[0], rows[1][0], rows[-1][0]) == (True, "┌", "└"), rows
    assert [row[0] for row in rows[2:-1]] == ["│"] * (len(rows) - 3), rows
    assert sum("j6     0.00" in row for row in rows) == 1
