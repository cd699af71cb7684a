"""Run the other examples as their users do: as programs, on simulated arms and real tools."""

from __future__ import annotations

import ast
import json
import os
import re
import select
import shutil
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from typing import Any

import pyarrow.parquet as pq
import pytest

from cobotwire import MyCobot280
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import PtyServer, RunningClock, SimulatedArm, TcpServer
from cobotwire_codegen.cli import main as generator
from examples.test_moving import load
from in_process import run as run_in_process
from newcomer.installing import run
from targets.c.compiled import compile_c, missing
from vectors import ROOT

FOLDER = ROOT / "examples"
SECONDS = 30.0


@pytest.fixture
def arm() -> Iterator[tuple[SimulatedArm, str]]:
    """Serve a fast simulated arm on a pty."""
    clock = RunningClock(20.0)
    arm = SimulatedArm(TABLE, clock=clock)
    with PtyServer(arm, clock) as server:
        yield arm, server.url


@contextmanager
def started(*words: str | Path, **options: Any) -> Iterator[subprocess.Popen[str]]:
    """Run a program until the block ends."""
    options = {"stdout": subprocess.PIPE, **options}
    process = subprocess.Popen(list(map(str, words)), text=True, **options)
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def test_table_lists_every_program_and_each_says_how_to_start_it() -> None:
    table = (FOLDER / "README.md").read_text(encoding="utf-8")
    linked = {FOLDER / link for link in re.findall(r"\]\(([^)]+)\)", table)}
    programs = sorted(FOLDER.rglob("*.py"))
    assert len(re.findall(r"^\| \[", table, re.MULTILINE)) == 10
    assert [path for path in programs if not {path, path.parent} & linked] == []
    assert [path for path in linked if not path.exists()] == []
    for path in programs:
        assert path.name in (ast.get_docstring(ast.parse(path.read_text())) or ""), path


def test_stream_is_written_to_a_parquet_file(
    arm: tuple[SimulatedArm, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = str(tmp_path / "angles.parquet")
    rows = load("stream_to_parquet")["main"](arm[1], file, 0.5)
    table = pq.read_table(file)
    assert table.num_rows == rows > 3
    assert table.column_names == ["time", "j1", "j2", "j3", "j4", "j5", "j6", "hottest"]
    times = table["time"].to_pylist()
    assert times == sorted(times)
    assert times[0] == 0
    assert f"{rows} samples" in capsys.readouterr().out


def test_pytest_of_the_robot_program_passes_and_finds_a_defect(tmp_path: Path) -> None:
    for name in ("sorting.py", "test_sorting.py"):
        shutil.copy(FOLDER / name, tmp_path)
    command = (sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "test_sorting.py")
    done = run(*command, cwd=tmp_path)
    assert "5 passed" in done.stdout
    program = tmp_path / "sorting.py"
    program.write_text(program.read_text().replace("grams <= LIMIT", "grams > LIMIT"))
    with pytest.raises(subprocess.CalledProcessError) as caught:
        run(*command, cwd=tmp_path)
    assert "3 failed" in caught.value.__notes__[0]


def test_http_server_reads_angles_moves_the_arm_and_refuses_bad_requests(
    arm: tuple[SimulatedArm, str],
) -> None:
    with started(sys.executable, FOLDER / "http_server.py", arm[1], "0") as server:
        assert server.stdout is not None
        url = server.stdout.readline().strip()

        def ask(path: str, data: bytes | None = None) -> Any:
            with urllib.request.urlopen(f"{url}{path}", data, timeout=SECONDS) as reply:
                return json.load(reply)

        assert ask("/angles") == [0.0] * 6
        assert ask("/angles", b"[0, 20, 0, 0, 0, 0]")[1] == pytest.approx(20, abs=0.2)
        # A stop during a motion: the request that waits for its end fails, and says why.
        moving: list[int] = []

        def move() -> None:
            try:
                ask("/angles", b"[160, 0, 0, 0, 0, 0]")
            except urllib.error.HTTPError as error:
                with error:
                    moving.append(error.code)

        motion = Thread(target=move)
        motion.start()
        while motion.is_alive() and ask("/angles")[0] < 5:
            pass
        assert ask("/stop", b"") == "stopped"
        motion.join(SECONDS)
        assert moving == [502]
        for path, data, code in [("/angles", b"[999]", 400), ("/nothing", None, 404)]:
            with pytest.raises(urllib.error.HTTPError) as caught:
                ask(path, data)
            with caught.value as refused:
                assert refused.code == code


def test_keys_of_a_terminal_jog_the_arm(arm: tuple[SimulatedArm, str]) -> None:
    simulated, url = arm
    master, slave = os.openpty()
    program, terminal = (
        FOLDER / "keyboard_jog.py",
        dict.fromkeys(("stdin", "stdout", "stderr"), slave),
    )
    with started(sys.executable, program, url, **terminal) as process:
        os.close(slave)
        shown = _press(master, b"", "[    0.0]")
        shown += _press(master, b"2+", "[    5.0]")
        assert simulated.state.angles.target(0.0)[:2] == pytest.approx((0, 5), abs=0.1)
        shown += _press(master, b"-", "[    0.0]")
        shown += _press(master, b"q", "bye")
        assert process.wait(SECONDS) == 0
    os.close(master)
    assert "Error" not in shown


def _press(master: int, keys: bytes, expected: str) -> str:
    """Send keys; wait for the expected text, and return all that was shown since."""
    if keys:
        os.write(master, keys)
    shown, deadline = "", time.monotonic() + SECONDS
    while expected not in shown:
        assert time.monotonic() < deadline, shown[-200:]
        assert select.select([master], [], [], SECONDS)[0], shown
        shown += os.read(master, 4096).decode()
    return shown


@pytest.mark.skipif(bool(missing("gcc")), reason=missing("gcc"))
def test_firmware_built_from_the_generated_c_talks_to_the_client(tmp_path: Path) -> None:
    spec = str(FOLDER / "firmware" / "arm280.yaml")
    words = ("build", spec, "--out", "arm280", "--c", "generated")
    assert run_in_process(generator, "cobotwire-gen", *words, folder=tmp_path).returncode == 0
    generated = tmp_path / "generated"
    program = tmp_path / "firmware"
    files = (str(FOLDER / "firmware" / "firmware.c"), str(generated / "arm280.c"))
    compile_c("gcc", f"-I{generated}", *files, "-o", str(program))
    with started(program) as firmware:
        assert firmware.stdout is not None
        with MyCobot280(firmware.stdout.readline().strip()) as arm:
            assert not arm.is_power_on()
            arm.send_angles([1, 2, 3, 4, 5, 6], 50)
            assert arm.get_angles() == (0,) * 6
            arm.power_on()
            assert arm.is_power_on()
            arm.send_angles([1, -2, 3, 4, 5, 6.5], 50)
            assert arm.get_angles() == (1, -2, 3, 4, 5, 6.5)


@pytest.mark.skipif(bool(missing("tshark", "text2pcap")), reason=missing("tshark", "text2pcap"))
def test_capture_of_wireshark_is_decoded(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Capture a real session byte by byte, and let Wireshark's own tool put it into TCP packets."""
    text: list[str] = []
    with TcpServer(SimulatedArm(TABLE).connect) as server, MyCobot280(server.url) as arm:
        arm.add_traffic_listener(
            lambda traffic: text.append(
                f"{'I' if traffic.direction == 'sent' else 'O'} 000000 {traffic.data.hex(' ')}\n"
            )
        )
        arm.power_on()
        assert arm.is_power_on()
        arm.get_angles()
    dump, capture = tmp_path / "session.txt", tmp_path / "session.pcapng"
    dump.write_text("".join(text))
    # -D: a packet with I goes from the first port to the second one, one with O the other way.
    run("text2pcap", "-D", "-T", "50000,9000", dump, capture)
    load("decode_wireshark")["main"](str(capture))
    lines = [line.split(maxsplit=1)[1] for line in capsys.readouterr().out.splitlines()]
    assert lines[0] == "host power_on()"
    assert "host is_power_on()" in lines
    assert any(line.startswith("arm  -> get_angles(") for line in lines)
    assert not any("noise" in line for line in lines)


def test_device_of_the_user_is_built_simulated_and_used(tmp_path: Path) -> None:
    for path in (FOLDER / "own_protocol").iterdir():
        if path.is_file():
            shutil.copy(path, tmp_path)
    words = ("build", "lamp.yaml", "--out", "lamp")
    assert run_in_process(generator, "cobotwire-gen", *words, folder=tmp_path).returncode == 0
    done = run(sys.executable, "use_lamp.py", cwd=tmp_path)
    assert done.stdout.splitlines() == [
        "the lamp is at 40 percent",
        "brightness is 101; allowed: a whole number 0..100 percent",
    ]
