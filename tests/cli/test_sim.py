"""Run ``cobotwire sim`` with ordinary clients, and with clients that never read."""

from __future__ import annotations

import fcntl
import json
import os
import re
import select
import signal
import socket
import struct
import subprocess
import termios
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from cobotwire import MyCobot, MyCobot280
from command_line import PROGRAM, run_program

COMMAND = [*PROGRAM, "sim"]


@pytest.fixture
def sim(request: pytest.FixtureRequest) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(
        [*COMMAND, *getattr(request, "param", ())],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_sim_serves_a_port_prints_the_traffic_and_ends_on_a_signal(
    sim: subprocess.Popen[str], how: signal.Signals
) -> None:
    assert sim.stdout is not None
    url = sim.stdout.readline().strip()
    assert url.startswith("/dev/")
    with MyCobot(url) as arm:
        assert arm.is_power_on() is False
    line = sim.stdout.readline()
    assert line == "received FE FE 02 12 FA   is_power_on()   reply FE FE 03 12 00 FA\n"
    sim.send_signal(how)
    assert sim.wait(timeout=10) == 0


def test_sim_continues_when_its_output_is_closed(sim: subprocess.Popen[str]) -> None:
    assert sim.stdout is not None
    assert sim.stderr is not None
    url = sim.stdout.readline().strip()
    sim.stdout.close()  # as head -1 does
    with MyCobot(url, timeout=5.0) as arm:
        arm.power_on()
        for _ in range(20):
            assert arm.is_power_on() is True
    sim.send_signal(signal.SIGTERM)
    assert sim.wait(timeout=10) == 0
    assert sim.stderr.read() == ""
    sim.stdout = None


@pytest.mark.parametrize("sim", [[], ["--json"]], indirect=True, ids=["text", "json"])
def test_arm_replies_while_nobody_reads_the_output(sim: subprocess.Popen[str]) -> None:
    assert sim.stdout is not None
    first = sim.stdout.readline().strip()
    url = json.loads(first)["url"] if first.startswith("{") else first
    # A pipe holds 64 KiB, and the program keeps 1 MiB.
    with MyCobot(url, timeout=5.0) as arm:
        for _ in range(20_000):
            assert arm.is_power_on() is False
        # A reader that comes late gets the first lines, and how many are missing.
        lines = []
        while "left out" not in (line := sim.stdout.readline()):
            assert "FE FE 02 12 FA" in line
            lines.append(line)
        assert len(lines) + int(re.findall(r"\d+", line)[0]) == 20_000
        # From then on no line is missing.
        arm.power_on()
        assert "power_on" in sim.stdout.readline()
    sim.send_signal(signal.SIGTERM)
    assert sim.wait(timeout=10) == 0


def test_sim_whose_output_nobody_reads_ends_on_a_signal(sim: subprocess.Popen[str]) -> None:
    assert sim.stdout is not None
    url = sim.stdout.readline().strip()
    with MyCobot(url, timeout=5.0) as arm:
        for _ in range(2000):
            arm.is_power_on()
    started = time.monotonic()
    sim.send_signal(signal.SIGTERM)
    assert sim.wait(timeout=10) == 0
    assert time.monotonic() - started < 5


@pytest.mark.parametrize("sim", [["--quiet"]], indirect=True)
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_sim_ends_while_a_client_does_not_read(
    sim: subprocess.Popen[str], how: signal.Signals
) -> None:
    assert sim.stdout is not None
    client = os.open(sim.stdout.readline().strip(), os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    try:
        for _ in range(400):
            assert select.select([], [client], [], 10.0)[1], "the arm still reads"
            os.write(client, bytes.fromhex("FE FE 02 20 FA") * 20)
        sim.send_signal(how)
        assert sim.wait(timeout=10) == 0
    finally:
        os.close(client)


@pytest.mark.parametrize("sim", [["--tcp", ":0"]], indirect=True)
def test_sim_over_tcp_numbers_the_clients(sim: subprocess.Popen[str]) -> None:
    assert sim.stdout is not None
    assert sim.stderr is not None
    url = sim.stdout.readline().strip()
    assert url.startswith("socket://127.0.0.1:")
    with MyCobot(url) as one:
        assert one.is_power_on() is False
        with MyCobot(url) as two:
            assert two.is_power_on() is False
    line = "received FE FE 02 12 FA   is_power_on()   reply FE FE 03 12 00 FA\n"
    assert [sim.stdout.readline() for _ in range(2)] == [f"  1 {line}", f"  2 {line}"]
    sim.send_signal(signal.SIGTERM)
    assert sim.wait(timeout=10) == 0
    assert sim.stderr.read() == ""


@pytest.mark.parametrize("sim", [["--tcp", "0.0.0.0:0", "--json", "--no-acks"]], indirect=True)
def test_sim_on_all_interfaces_prints_json_and_a_warning(sim: subprocess.Popen[str]) -> None:
    assert sim.stdout is not None
    assert sim.stderr is not None
    serving = json.loads(sim.stdout.readline())
    assert serving["event"] == "serving"
    with MyCobot(serving["url"]) as arm:
        arm.set_color(1, 2, 3)
        assert arm.is_power_on() is False
    events = [json.loads(sim.stdout.readline()) for _ in range(2)]
    assert events[0]["command"] == "set_color"
    assert events[0]["fields"] == {"red": 1, "green": 2, "blue": 3}
    assert "reply" not in events[0]
    assert events[1] == {
        "client": 1,
        "event": "received",
        "data": "FE FE 02 12 FA",
        "command": "is_power_on",
        "fields": {},
        "reply": "FE FE 03 12 00 FA",
    }
    assert "anyone who can reach 0.0.0.0" in sim.stderr.readline()


@pytest.mark.parametrize("sim", [["--json"]], indirect=True)
def test_sim_prints_why_a_request_is_ignored(sim: subprocess.Popen[str]) -> None:
    assert sim.stdout is not None
    url = json.loads(sim.stdout.readline())["url"]
    with MyCobot(url) as arm:
        arm.send_angles([10, 0, 0, 0, 0, 0], speed=30)
        assert arm.is_moving() is False
    note = json.loads(sim.stdout.readline())
    assert note["event"] == "note"
    assert note["command"] == "send_angles"
    assert "power" in note["text"]


@pytest.mark.parametrize("sim", [["--speed", "100"]], indirect=True)
def test_speed_option_makes_the_arm_faster(sim: subprocess.Popen[str]) -> None:
    assert sim.stdout is not None
    with MyCobot(sim.stdout.readline().strip()) as arm:
        arm.power_on()
        started = time.monotonic()
        arm.move_angles([100, 0, 0, 0, 0, 0], 5)  # some 13 s
        assert time.monotonic() - started < 5


def test_sim_shows_a_table_of_the_joints_on_a_terminal() -> None:
    master, slave = os.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("4H", 24, 120, 0, 0))
    process = subprocess.Popen(COMMAND, stdout=slave, stderr=slave, text=True)
    try:
        shown = _until(master, b"Ctrl-C ends")
        url = next(word for word in shown.decode().split() if word.startswith("/dev/"))
        with MyCobot(url) as arm:
            arm.power_on()
            arm.move_angles([45, 0, 0, 0, 0, 0], 100)
        shown += _until(master, b"j1=45.0")
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=10) == 0
        shown += _until(master, b"\x1b[?25h")  # the cursor is shown again
    finally:
        process.kill()
        process.wait()
        os.close(master)
        os.close(slave)
    assert b"send_angles" in shown
    assert b"joints, degrees" in shown
    assert b"Traceback" not in shown


def _until(descriptor: int, wanted: bytes) -> bytes:
    shown = b""
    deadline = time.monotonic() + 20
    while wanted not in shown and time.monotonic() < deadline:
        if select.select([descriptor], [], [], 0.1)[0]:
            shown += os.read(descriptor, 65536)
    assert wanted in shown, shown[-2000:]
    return shown


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--tcp", "9000"], "HOST:PORT"),
        (["--tcp", ":70000"], "70000"),
        (["--pty", "--tcp", ":0"], "use either --pty or --tcp, not both"),
        (["--speed", "0"], "speed"),
        (["--speed", "nan"], "speed"),
    ],
)
def test_wrong_options_are_rejected(words: list[str], message: str) -> None:
    result = run_program("sim", *words)
    assert result.returncode == 2
    assert message in result.stderr
    assert "Traceback" not in result.stderr


def test_tcp_port_in_use_has_the_exit_code_of_a_failed_port() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        result = run_program("sim", "--tcp", f"127.0.0.1:{taken.getsockname()[1]}")
    assert result.returncode == 3
    assert "cannot listen" in result.stderr


SLOW = """\
faults:
  - fault: late
    seconds: 0.01
"""


def test_faults_are_injected_for_every_client_and_printed(tmp_path: Path) -> None:
    path = tmp_path / "slow.yaml"
    path.write_text(SLOW)
    process = subprocess.Popen(
        [*COMMAND, "--scenario", str(path), "--json", "--tcp", ":0"],
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout is not None
        url = json.loads(process.stdout.readline())["url"]
        for _ in range(2):
            with MyCobot(url) as arm:
                assert arm.is_power_on() is False
        process.send_signal(signal.SIGTERM)
        events = [json.loads(line) for line in process.stdout]
    finally:
        process.kill()
        process.communicate()
    assert [(line["client"], line["event"]) for line in events] == [
        (1, "received"),
        (1, "fault"),
        (2, "received"),
        (2, "fault"),
    ]


@pytest.mark.skipif(
    not Path("/proc/self/maps").exists(), reason="reads /proc, which only Linux has"
)
def test_sim_solves_a_target_at_the_edge_of_the_reach_without_numpy_and_scipy(
    sim: subprocess.Popen[str],
) -> None:
    # Their import takes longer than the deadline of the reply.
    assert sim.stdout is not None
    stretched, given = (48.6, -64.6, 410.9, -90.0, 0.0, -90.0), (0.0, 0.0, 10.0, 0.0, 0.0, 0.0)
    with MyCobot280(sim.stdout.readline().strip()) as arm:
        solved = arm.solve_inv_kinematics(stretched, given)
    assert solved != given
    maps = Path(f"/proc/{sim.pid}/maps").read_text()
    assert "/python" in maps
    assert "/numpy/" not in maps
    assert "/scipy/" not in maps
