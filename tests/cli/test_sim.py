"""``cobotwire sim`` and whoever reads, or does not read, what it prints and answers."""

from __future__ import annotations

import os
import select
import signal
import subprocess
import sys
from collections.abc import Iterator

import pytest

from cobotwire import MyCobot

COMMAND = [sys.executable, "-c", "from cobotwire.cli import main; main()", "sim"]


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
def test_sim_serves_a_port_shows_the_frames_and_ends_cleanly(
    sim: subprocess.Popen[str], how: signal.Signals
) -> None:
    assert sim.stdout is not None
    url = sim.stdout.readline().strip()
    assert url.startswith("/dev/")
    with MyCobot(url) as arm:
        assert arm.is_power_on() is False
    line = sim.stdout.readline()
    assert line == "heard   FE FE 02 12 FA   is_power_on()   answered FE FE 03 12 00 FA\n"
    sim.send_signal(how)
    assert sim.wait(timeout=10) == 0


def test_it_goes_on_when_nobody_reads_its_output_any_more(sim: subprocess.Popen[str]) -> None:
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


@pytest.mark.parametrize("sim", [["--quiet"]], indirect=True)
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_it_ends_while_a_client_does_not_read(
    sim: subprocess.Popen[str], how: signal.Signals
) -> None:
    assert sim.stdout is not None
    client = os.open(sim.stdout.readline().strip(), os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    try:
        for _ in range(400):
            assert select.select([], [client], [], 10.0)[1], "the arm still listens"
            os.write(client, bytes.fromhex("FE FE 02 20 FA") * 20)
        sim.send_signal(how)
        assert sim.wait(timeout=10) == 0
    finally:
        os.close(client)
