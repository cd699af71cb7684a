"""Complete words as bash, zsh and fish do."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from cobotwire import editions
from cobotwire.cli.completion import SHELLS
from cobotwire.simulator.faults import shipped
from command_line import PROGRAM, run_program

CASES = [
    ("mon", {"monitor"}),
    ("conform dev", {"device"}),
    ("--edition myc", {name for name in editions.names() if name.startswith("myc")}),
    ("commands send_", {"send_angle", "send_angles", "send_coord", "send_coords"}),
    ("--edition mycobot280 call /dev/x set_ssid", {"set_ssid_pwd"}),
    ("sim --scenario late", {name for name in shipped() if name.startswith("late")}),
    ("completion z", {"zsh"}),
]


def complete(shell: str, line: str) -> set[str]:
    words = ["cobotwire", *line.split()]
    given = {"COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)}
    if shell == "fish":  # it gives the word instead of its index
        given["COMP_CWORD"] = words[-1]
    result = run_program(_COBOTWIRE_COMPLETE=f"{shell}_complete", **given)
    lines = result.stdout.splitlines()
    if shell == "zsh":  # three lines for each word: its type, the word, a description
        return set(lines[1::3])
    return {line.partition(",")[2].partition("\t")[0] for line in lines}


@pytest.mark.parametrize("shell", SHELLS)
@pytest.mark.parametrize(("line", "expected"), CASES)
def test_words_are_completed_in_every_shell(shell: str, line: str, expected: set[str]) -> None:
    assert expected <= complete(shell, line)
    start = line.split()[-1]
    assert all(word.startswith(start) for word in complete(shell, line))


def test_ports_are_completed_for_every_verb_that_opens_one(tmp_path: Path) -> None:
    # pyserial finds no port on most test machines, so the list is replaced.
    script = (
        "from types import SimpleNamespace as Port\n"
        "import cobotwire.transport.serial.ports as serial_ports\n"
        "serial_ports.ports = lambda: [Port(device='/dev/ttyACM7')]\n"
        "from cobotwire.cli import main; main()"
    )
    for verb in ("call", "doctor", "monitor", "conform device"):
        words = ["cobotwire", *verb.split(), "/dev/ttyA"]
        given = {"COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)}
        result = subprocess.run(
            [*PROGRAM[:-1], script],
            capture_output=True,
            text=True,
            env={**os.environ, **given, "_COBOTWIRE_COMPLETE": "bash_complete"},
            check=False,
        )
        assert result.stdout.split() == ["plain,/dev/ttyACM7"], verb


@pytest.mark.parametrize("shell", SHELLS)
def test_script_is_accepted_by_its_shell(shell: str, tmp_path: Path) -> None:
    script = run_program("completion", shell).stdout
    assert f"_COBOTWIRE_COMPLETE={shell}_complete" in script
    program = shutil.which(shell)
    if program is None:
        pytest.skip(f"{shell} is not installed")
    path = tmp_path / "script"
    path.write_text(script)
    result = subprocess.run([program, "-n", path], capture_output=True, text=True, check=False)
    assert (result.returncode, result.stderr) == (0, "")


def test_bash_completes_with_the_printed_script(tmp_path: Path) -> None:
    program = tmp_path / "cobotwire"
    program.write_text(f"#!/bin/sh\nexec {PROGRAM[0]} -c '{PROGRAM[2]}' \"$@\"\n")
    program.chmod(0o755)
    script = (
        'eval "$(cobotwire completion bash)"\n'
        "COMP_WORDS=(cobotwire sim --scenario pan); COMP_CWORD=3\n"
        "_cobotwire_completion cobotwire\n"
        'echo "${COMPREPLY[@]}"'
    )
    result = subprocess.run(
        ["bash", "-c", script],
        capture_output=True,
        text=True,
        env={**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}"},
        check=False,
    )
    assert (result.stdout, result.stderr) == ("panic\n", "")
