"""``cobotwire sim --scenario``: faults on a port that any program opens."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from cobotwire import MyCobot

SIM = [sys.executable, "-c", "from cobotwire.cli import main; main()", "sim"]


def test_a_shipped_scenario_is_done_and_told() -> None:
    with subprocess.Popen([*SIM, "--scenario", "servo-leaks"], stdout=subprocess.PIPE) as process:
        try:
            assert process.stdout is not None
            url = process.stdout.readline().decode().strip()
            with MyCobot(url) as arm:
                assert list(arm.get_angles()) == list(arm.get_angles()) == [0.0] * 6
            told = [process.stdout.readline().decode() for _ in range(3)]
        finally:
            process.terminate()
    (line,) = [line for line in told if "servo-leak" in line]
    assert "at get_angles: FF FF" in line
    assert "in front of the reply" in line


def test_scenarios_are_listed_with_a_sentence_each() -> None:
    listed = subprocess.run([*SIM, "--list-scenarios"], capture_output=True, text=True, check=True)
    lines = listed.stdout.splitlines()
    assert len(lines) == 39
    assert "panic                 The firmware panics" in listed.stdout


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--scenario", "merged-aks"], "did you mean merged-acks?"),
        (["--seed", "3"], "seed is 3; allowed: nothing without --scenario"),
        (["--scenario", "bad.yaml"], "bad.yaml:1:18: there is no fault lots; did you mean lost?"),
    ],
)
def test_what_cannot_be_played_is_refused(options: list[str], words: str, tmp_path: Path) -> None:
    (tmp_path / "bad.yaml").write_text("faults: [{fault: lots}]")
    ended = subprocess.run([*SIM, *options], capture_output=True, text=True, cwd=tmp_path)
    assert ended.returncode == 2
    assert words in ended.stderr
    assert ended.stdout == ""
