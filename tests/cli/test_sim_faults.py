"""Run ``cobotwire sim --scenario``."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from cobotwire import MyCobot
from command_line import PROGRAM

SIM = [*PROGRAM, "sim"]


def test_faults_of_a_shipped_scenario_are_injected_and_printed() -> None:
    with subprocess.Popen([*SIM, "--scenario", "servo-leaks"], stdout=subprocess.PIPE) as process:
        try:
            assert process.stdout is not None
            url = process.stdout.readline().decode().strip()
            with MyCobot(url) as arm:
                assert list(arm.get_angles()) == list(arm.get_angles()) == [0.0] * 6
            lines = [process.stdout.readline().decode() for _ in range(3)]
        finally:
            process.terminate()
    (line,) = [line for line in lines if "servo-leak" in line]
    assert "at get_angles: FF FF" in line
    assert "before the reply" in line


def test_list_scenarios_prints_a_sentence_for_each() -> None:
    listed = subprocess.run([*SIM, "--list-scenarios"], capture_output=True, text=True, check=True)
    lines = listed.stdout.splitlines()
    assert len(lines) == 39
    assert re.search(r"^panic +The firmware panics", listed.stdout, re.MULTILINE)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--scenario", "merged-aks"], "did you mean merged-acks?"),
        (["--seed", "3"], "--seed needs --scenario"),
        (["--scenario", "bad.yaml"], "bad.yaml:1:18: there is no fault lots; did you mean lost?"),
    ],
)
def test_invalid_scenario_is_rejected(options: list[str], words: str, tmp_path: Path) -> None:
    (tmp_path / "bad.yaml").write_text("faults: [{fault: lots}]")
    ended = subprocess.run([*SIM, *options], capture_output=True, text=True, cwd=tmp_path)
    assert ended.returncode == 2
    assert words in ended.stderr
    assert ended.stdout == ""
