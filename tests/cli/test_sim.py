"""Run ``cobotwire sim`` with ordinary clients, and with clients that never read."""

from __future__ import annotations

import json
import os
import re
import select
import signal
import socket
import time
from collections.abc import Iterator
from pathlib import Path
from subprocess import Popen

import pytest

from cobotwire import MyCobot, MyCobot280
from cobotwire.cli.shared import line_output
from cobotwire.transport.opening import open_transport
from command_line import printed, started
from in_process import cobotwire

QUERY = "received FE FE 02 12 FA   is_power_on()   reply FE FE 03 12 00 FA\n"


def with_options(*words: str) -> pytest.MarkDecorator:
    """Start the program of a test with these options."""
    return pytest.mark.parametrize("sim", [words], indirect=True, ids=["sim"])


@pytest.fixture
def sim(request: pytest.FixtureRequest) -> Iterator[Popen[str]]:
    with started("sim", *getattr(request, "param", ())) as process:
        yield process


def end(sim: Popen[str], how: signal.Signals = signal.SIGTERM) -> None:
    """End the program with a signal; check its exit code."""
    sim.send_signal(how)
    assert sim.wait(timeout=10) == (143 if how == signal.SIGTERM else 0)


def errors(sim: Popen[str]) -> str:
    assert sim.stderr is not None
    return sim.stderr.read()


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_sim_serves_a_port_prints_the_traffic_and_ends_on_a_signal(
    sim: Popen[str], how: signal.Signals
) -> None:
    url = printed(sim).strip()
    assert url.startswith("/dev/")
    with MyCobot(url) as arm:
        assert arm.is_power_on() is False
    assert printed(sim) == QUERY
    end(sim, how)


def test_sim_continues_when_its_output_is_closed(sim: Popen[str]) -> None:
    url = printed(sim).strip()
    assert sim.stdout is not None
    sim.stdout.close()  # as head -1 does
    with MyCobot(url, timeout=5.0) as arm:
        arm.power_on()
        for _ in range(20):
            assert arm.is_power_on() is True
    end(sim)
    assert errors(sim) == ""
    sim.stdout = None


@pytest.mark.parametrize("words", [[], ["--json"]], ids=["text", "json"])
def test_arm_replies_while_nobody_reads_the_output(words: list[str]) -> None:
    assert line_output.KEPT <= 1 << 20
    # This buffer and the pipe's 64 KiB are too small for all lines.
    less = "from cobotwire.cli.shared import line_output; line_output.KEPT = 1 << 16"
    requests = 2500
    with started("sim", *words, first=less) as sim:
        first = printed(sim).strip()
        url = json.loads(first)["url"] if first.startswith("{") else first
        with MyCobot(url, timeout=5.0) as arm:
            for _ in range(requests):
                assert arm.is_power_on() is False
            # A late reader gets the first lines, and the number of missing ones.
            lines = []
            while "left out" not in (line := printed(sim)):
                assert "FE FE 02 12 FA" in line
                lines.append(line)
            assert len(lines) + int(re.findall(r"\d+", line)[0]) == requests
            # No later line is missing.
            arm.power_on()
            assert "power_on" in printed(sim)
        end(sim)


def test_sim_whose_output_nobody_reads_ends_on_a_signal(sim: Popen[str]) -> None:
    with MyCobot(printed(sim).strip(), timeout=5.0) as arm:
        for _ in range(2000):
            arm.is_power_on()
    started_at = time.monotonic()
    end(sim)
    assert time.monotonic() - started_at < 5


@with_options("--quiet")
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_sim_ends_while_a_client_does_not_read(sim: Popen[str], how: signal.Signals) -> None:
    client = os.open(printed(sim).strip(), os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    try:
        for _ in range(400):
            assert select.select([], [client], [], 10.0)[1], "the arm still reads"
            os.write(client, bytes.fromhex("FE FE 02 20 FA") * 20)
        end(sim, how)
    finally:
        os.close(client)


@with_options("--tcp", ":0")
def test_sim_over_tcp_numbers_the_clients(sim: Popen[str]) -> None:
    url = printed(sim).strip()
    assert url.startswith("socket://127.0.0.1:")
    with MyCobot(url) as one:
        assert one.is_power_on() is False
        with MyCobot(url) as two:
            assert two.is_power_on() is False
    assert [printed(sim) for _ in range(2)] == [f"  1 {QUERY}", f"  2 {QUERY}"]
    end(sim)
    assert errors(sim) == ""


@with_options("--tcp", "0.0.0.0:0", "--json", "--no-acks")
def test_sim_on_all_interfaces_prints_json_and_a_warning(sim: Popen[str]) -> None:
    serving = json.loads(printed(sim))
    assert serving["event"] == "serving"
    with MyCobot(serving["url"]) as arm:
        arm.set_color(1, 2, 3)
        assert arm.is_power_on() is False
    events = [json.loads(printed(sim)) for _ in range(2)]
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
    assert sim.stderr is not None
    assert "anyone who can reach 0.0.0.0" in sim.stderr.readline()


@with_options("--json")
def test_sim_prints_why_a_request_is_ignored(sim: Popen[str]) -> None:
    with MyCobot(json.loads(printed(sim))["url"]) as arm:
        arm.send_angles([10, 0, 0, 0, 0, 0], speed=30)
        assert arm.is_moving() is False
    note = json.loads(printed(sim))
    assert (note["event"], note["command"]) == ("note", "send_angles")
    assert "power" in note["text"]


@with_options("--speed", "100")
def test_speed_option_makes_the_arm_faster(sim: Popen[str]) -> None:
    with MyCobot(printed(sim).strip()) as arm:
        arm.power_on()
        started_at = time.monotonic()
        arm.move_angles([100, 0, 0, 0, 0, 0], 5)  # some 13 s
        assert time.monotonic() - started_at < 5


@pytest.mark.parametrize("port", [[], ["--tcp", ":0"]], ids=["pty", "tcp"])
def test_powered_arm_moves_without_power_on(port: list[str]) -> None:
    with started("sim", "--quiet", "--powered", *port) as sim:
        with MyCobot280(printed(sim).strip(), timeout=5.0) as arm:
            assert arm.is_power_on() is True
            assert arm.is_all_servo_enable() is True
            arm.send_angle(1, 5, 100)
            time.sleep(0.3)
            assert arm.get_angles().j1 > 1


def test_arm_acknowledges_a_setter() -> None:
    expected = bytes.fromhex("FE FE 03 16 01 FA FE FE 03 12 00 FA")
    with started("sim", "--quiet") as sim:
        transport = open_transport(printed(sim).strip(), 115200)
        transport.write(bytes.fromhex("FE FE 03 16 01 FA FE FE 02 12 FA"))
        received, until = b"", time.monotonic() + 5
        while (left := until - time.monotonic()) > 0 and len(received) < len(expected):
            received += transport.read(left)
        transport.close()
    assert received == expected


def test_arm_that_is_led_moves_when_it_is_released(tmp_path: Path) -> None:
    path = tmp_path / "hand.txt"
    path.write_text("0.1 10 0 0 0 0 0\n0.2 10 -20 0 0 0 0\n")
    with started("sim", "--quiet", "--powered", "--led", path) as sim:
        with MyCobot280(printed(sim).strip(), timeout=5.0) as arm:
            assert tuple(arm.get_angles()) == (0.0,) * 6
            arm.release_all_servos()
            time.sleep(0.4)
            assert tuple(arm.get_angles()) == pytest.approx((10, -20, 0, 0, 0, 0), abs=0.1)


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (["--tcp", "9000"], 2, "HOST:PORT"),
        (["--tcp", ":70000"], 2, "70000"),
        (["--pty", "--tcp", ":0"], 2, "use either --pty or --tcp, not both"),
        (["--speed", "0"], 2, "speed"),
        (["--speed", "nan"], 2, "speed"),
        (["--scenario", "merged-aks"], 2, "did you mean merged-acks?"),
        (["--seed", "3"], 2, "--seed needs --scenario"),
        (["--scenario", "BAD"], 2, "bad.yaml:1:18: there is no fault lots; did you mean lost?"),
        (["--led", "/nowhere/hand.txt"], 2, "/nowhere/hand.txt: No such file"),
        (["--tcp", "TAKEN"], 3, "cannot listen"),
    ],
)
def test_wrong_options_are_rejected(
    tmp_path: Path, words: list[str], code: int, message: str
) -> None:
    bad = tmp_path / "bad.yaml"
    bad.write_text("faults: [{fault: lots}]")
    with socket.create_server(("127.0.0.1", 0)) as taken:
        known = {"BAD": str(bad), "TAKEN": f"127.0.0.1:{taken.getsockname()[1]}"}
        result = cobotwire("sim", *(known.get(word, word) for word in words))
    assert (result.returncode, result.stdout) == (code, "")
    assert message in result.stderr


def test_faults_are_injected_for_every_client_and_printed(tmp_path: Path) -> None:
    path = tmp_path / "slow.yaml"
    path.write_text("faults:\n  - {fault: late, seconds: 0.01}\n")
    with started("sim", "--scenario", path, "--json", "--tcp", ":0") as sim:
        url = json.loads(printed(sim))["url"]
        for _ in range(2):
            with MyCobot(url) as arm:
                assert arm.is_power_on() is False
        events = [json.loads(printed(sim)) for _ in range(4)]
    found = [(line["client"], line["event"]) for line in events]
    assert found == [(1, "received"), (1, "fault"), (2, "received"), (2, "fault")]


@with_options("--scenario", "servo-leaks")
def test_faults_of_a_shipped_scenario_are_injected_and_printed(sim: Popen[str]) -> None:
    with MyCobot(printed(sim).strip()) as arm:
        assert list(arm.get_angles()) == list(arm.get_angles()) == [0.0] * 6
    (line,) = [line for line in (printed(sim) for _ in range(3)) if "servo-leak" in line]
    assert "at get_angles: FF FF" in line
    assert "before the reply" in line


def test_list_scenarios_prints_a_sentence_for_each() -> None:
    listed = cobotwire("sim", "--list-scenarios").stdout
    assert len(listed.splitlines()) == 39
    assert re.search(r"^panic +The firmware panics", listed, re.MULTILINE)


@pytest.mark.skipif(
    not Path("/proc/self/maps").exists(), reason="reads /proc, which only Linux has"
)
def test_sim_solves_a_target_at_the_edge_of_the_reach_without_numpy_and_scipy(
    sim: Popen[str],
) -> None:
    # Importing NumPy and SciPy takes longer than the deadline of the reply.
    stretched, given = (48.6, -64.6, 410.9, -90.0, 0.0, -90.0), (0.0, 0.0, 10.0, 0.0, 0.0, 0.0)
    with MyCobot280(printed(sim).strip()) as arm:
        assert arm.solve_inv_kinematics(stretched, given) != given
    maps = Path(f"/proc/{sim.pid}/maps").read_text()
    assert "/python" in maps
    assert "/numpy/" not in maps
    assert "/scipy/" not in maps
