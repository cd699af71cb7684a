"""Test the options of ``cobotwire sim`` that choose how its arm starts and what it does."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from cobotwire.editions.mycobot280 import MyCobot280
from cobotwire.transport.opening import open_transport
from command_line import PROGRAM, run_program


@contextmanager
def _serving(*options: str) -> Iterator[str]:
    """Serve today's arm with ``options`` in another process; yield its port."""
    command = [*PROGRAM, "--edition", "mycobot280", "sim", *options]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            yield process.stdout.readline().strip()
        finally:
            process.terminate()


def _received(url: str, words: str, seconds: float) -> str:
    """Send requests in hex; return what comes within a time, or the reply to is_power_on."""
    transport = open_transport(url, 115200)
    try:
        transport.write(bytes.fromhex(words))
        received, until = b"", time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0 and received[-4:-2] != b"\x03\x12":
            received += transport.read(left)
        return received.hex(" ").upper()
    finally:
        transport.close()


@pytest.mark.parametrize("port", [[], ["--tcp", ":0"]], ids=["pty", "tcp"])
@pytest.mark.parametrize("powered", [False, True])
def test_powered_arm_moves_without_power_on(port: list[str], powered: bool) -> None:
    options = ["--powered"] if powered else []
    with _serving("--quiet", *options, *port) as url, MyCobot280(url, timeout=5.0) as arm:
        assert arm.is_power_on() is powered
        assert arm.is_all_servo_enable() is powered
        arm.send_angle(1, 5, 100)
        time.sleep(0.3)
        assert (arm.get_angles().j1 > 1) is powered


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ([], "FE FE 03 16 01 FA FE FE 03 12 00 FA"),
        (["--no-acks"], "FE FE 03 12 00 FA"),
    ],
)
def test_arm_without_acks_replies_to_queries_alone(options: list[str], expected: str) -> None:
    with _serving("--quiet", *options) as url:
        assert _received(url, "FE FE 03 16 01 FA FE FE 02 12 FA", 5) == expected


def test_arm_that_is_led_moves_when_it_is_released(tmp_path: Path) -> None:
    path = tmp_path / "hand.txt"
    path.write_text("0.1 10 0 0 0 0 0\n0.2 10 -20 0 0 0 0\n")
    with _serving("--quiet", "--powered", "--led", str(path)) as url:
        with MyCobot280(url, timeout=5.0) as arm:
            assert tuple(arm.get_angles()) == (0.0,) * 6
            arm.release_all_servos()
            time.sleep(0.4)
            assert tuple(arm.get_angles()) == pytest.approx((10, -20, 0, 0, 0, 0), abs=0.1)


def test_file_that_is_missing_is_reported_in_one_line() -> None:
    result = run_program("sim", "--led", "/nowhere/hand.txt")
    assert result.returncode != 0
    assert "/nowhere/hand.txt: No such file" in result.stderr
    assert "Traceback" not in result.stderr
