"""Run ``cobotwire doctor`` on the simulated arm, and on bad lines."""

from __future__ import annotations

import json
import threading
import time
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from cobotwire import editions
from cobotwire.capture import read
from cobotwire.editions.mycobot import TABLE
from cobotwire.inspect.doctor import SLOW_SECONDS
from cobotwire.simulator import PtyServer, SimulatedArm
from in_process import cobotwire
from scripted_peer import ScriptedPeer, ScriptedTcpPeer, Step

run = partial(cobotwire, "--edition", "mycobot", "doctor")
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
RUNNING = bytes.fromhex("FE FE 03 27 00 FA")
STILL = bytes.fromhex("FE FE 03 2B 00 FA")
ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
COORDS = bytes.fromhex("FE FE 0E 23 01 BC FD A0 10 0D DC 66 FF 54 DE 21 FA")
HEALTHY: list[list[Step]] = [
    [POWERED],
    [RUNNING],
    [STILL],
    [ANGLES],
    [COORDS],
    [ANGLES],
    [ANGLES],
]
SPEED = bytes.fromhex("FE FE 03 40 32 FA")
PANIC = (
    b"Guru Meditation Error: Core 1 panic'ed (LoadProhibited). Exception was unhandled.\r\n"
    b"Rebooting...\r\n" + bytes(277)
)
LEAK = bytes.fromhex("FF FF 01 04 02 38 02 BE")


def examined(scripts: list[list[Step]], *words: str) -> tuple[int, dict[str, Any]]:
    with ScriptedPeer(*scripts) as peer:
        result = run(peer.url, "--json", "--count", "2", "--timeout", "0.15", *words)
    assert result.stderr == ""
    return result.returncode, json.loads(result.stdout)


def kinds(report: dict[str, Any]) -> list[str]:
    """Return the kinds of the problems, without ``slow``, which a busy machine causes."""
    found = [problem["kind"] for problem in report["problems"]]
    times = report["round_trip"]
    slow = times is not None and times["median"] > SLOW_SECONDS
    assert ("slow" in found) == slow
    return [kind for kind in found if kind != "slow"]


def with_noise(noise: bytes) -> list[list[Step]]:
    """Return the scripts of a healthy arm with noise before one reply."""
    return [*HEALTHY[:3], [noise, *HEALTHY[3]], *HEALTHY[4:], [SPEED]]


def test_doctor_of_a_healthy_arm_sends_only_queries() -> None:
    with ScriptedPeer(*HEALTHY, [SPEED]) as peer:
        result = run(peer.url, "--count", "2")
        requests = peer.received
    assert (result.returncode, result.stderr) == (0, "")
    assert "7 replies to 7 requests" in result.stdout
    assert "round trip" in result.stdout
    assert result.stdout.endswith("healthy\n")
    sent = {requests[place + 3] for place in range(0, len(requests), 5)}
    by_id = {command.id: command.safety for command in TABLE.commands if command.id in sent}
    assert set(by_id.values()) == {"query"}


@pytest.mark.parametrize(
    ("noise", "kind", "diagnosis"),
    [
        (PANIC, "panic", "the controller rebooted: panic LoadProhibited"),
        (LEAK, "servo", "servo bus leak"),
        (b"cmd_len error\r\n", "cmd-len-error", "the firmware reported cmd_len error"),
        (bytes.fromhex("78 80 78 80 78 80 F8 00 78 78 80 80"), "garbage", "a wrong baud rate"),
    ],
)
def test_doctor_diagnoses_noise_and_gives_advice(noise: bytes, kind: str, diagnosis: str) -> None:
    code, report = examined(with_noise(noise))
    assert code == 1
    assert kind in kinds(report)
    assert diagnosis in report["diagnosis"]
    assert report["replies"] == report["requests"] == 7
    assert report["noise"] == len(noise)
    assert all(problem["advice"] for problem in report["problems"])


def test_doctor_of_a_silent_arm_stops_after_three_requests() -> None:
    started = time.monotonic()
    code, report = examined([])
    assert (code, kinds(report)) == (1, ["silence"])
    assert (report["requests"], report["replies"], report["healthy"]) == (3, 0, False)
    assert time.monotonic() - started < 20


def test_doctor_reports_lost_and_illegal_replies() -> None:
    illegal = bytes.fromhex("FE FE 03 2B 07 FA")
    code, report = examined([[], [RUNNING], [illegal], *HEALTHY[3:], [SPEED]])
    assert code == 1
    assert kinds(report) == ["illegal-reply", "lost-replies"]
    assert report["problems"][1]["text"] == ("no reply in time to 1 of 7 requests (is_power_on)")


def test_doctor_without_a_port_exits_with_3_and_reports_what_it_found() -> None:
    result = run("/dev/nosuchport", "--json")
    assert result.returncode == 3
    assert kinds(json.loads(result.stdout)) == ["link"]
    assert run("/dev/nosuchport").stdout.startswith("! link: /dev/nosuchport: cannot be opened")
    code, report = examined([*HEALTHY[:3], [LEAK, 0.1, None]])
    assert code == 3
    assert kinds(report)[0] == "link"
    assert "servo" in kinds(report)
    assert report["replies"] == 3


def test_doctor_works_over_tcp_and_records(tmp_path: Path) -> None:
    path = tmp_path / "doctor.pcapng"
    # After the requests that are counted, the doctor checks the edition.
    with ScriptedTcpPeer(*HEALTHY, [SPEED]) as peer:
        result = run(peer.url, "--count", "2", "--record", path)
    assert result.returncode == 0, result.stdout
    capture = read(path)
    assert [packet.direction for packet in capture] == ["sent", "received"] * 8
    assert capture.finished


def test_doctor_diagnoses_noise_before_the_first_request() -> None:
    with ScriptedPeer(*HEALTHY, [SPEED]) as peer:
        stopping = threading.Event()

        def send() -> None:
            while not stopping.wait(0.05) and not peer.received:
                peer.send(LEAK)

        thread = threading.Thread(target=send)
        thread.start()
        result = run(peer.url, "--count", "2")
        stopping.set()
        thread.join()
    assert result.returncode == 1
    assert "servo bus leak" in result.stdout


@pytest.mark.parametrize(("client", "arm"), [("mycobot280", "mycobot"), ("mycobot", "mycobot280")])
def test_doctor_with_the_wrong_edition_names_the_arms_edition(client: str, arm: str) -> None:
    with PtyServer(SimulatedArm(editions.load(arm).TABLE, powered=True)) as server:
        result = cobotwire(
            "--edition", client, "doctor", server.url, "--json", "--count", "2", "--timeout", "0.2"
        )
        assert result.returncode == 1, result.stdout
        # One edition has queries that the other lacks; they get no reply.
        problem, *lost = [p for p in json.loads(result.stdout)["problems"] if p["serious"]]
        assert {each["kind"] for each in lost} <= {"lost-replies"}
        assert problem["kind"] == "other-edition"
        assert f"the arm speaks edition {arm}, not {client}" in problem["text"]
        assert f"--edition {arm}" in problem["advice"]
        right = cobotwire("--edition", arm, "doctor", server.url, "--count", "2")
        assert (right.returncode, right.stdout.endswith("healthy\n")) == (0, True)
