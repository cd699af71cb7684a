"""Complete words as bash, zsh and fish do."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from cli.test_same_words import subcommands
from cobotwire import editions
from cobotwire.cli.app import app
from cobotwire.cli.completion import SHELLS
from cobotwire.simulator.faults import shipped
from cobotwire.transport.serial import ports as serial_ports
from cobotwire.transport.serial.ports import Port
from command_line import PROGRAM, run_program

CASES = [
    ("mon", {"monitor"}),
    ("conform dev", {"device"}),
    ("--edition myc", {name for name in editions.names() if name.startswith("myc")}),
    ("commands send_", {"send_angle", "send_angles", "send_coord", "send_coords"}),
    ("call --edition mercury_a1 /dev/x write_move", {"write_move_c"}),
    ("call /dev/x go_", {"go_home"}),
    ("sim --scenario late", {name for name in shipped() if name.startswith("late")}),
    ("completion z", {"zsh"}),
]


def complete(shell: str, line: str) -> set[str]:
    words = ["cobotwire", *line.split()]
    given = {"COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)}
    if shell == "fish":  # it gives the word instead of its index
        given["COMP_CWORD"] = words[-1]
    # CliRunner runs the program in this process; the tests of scripts below run it in a shell.
    given |= {"_COBOTWIRE_COMPLETE": f"{shell}_complete"}
    lines = CliRunner(env=given).invoke(app, prog_name="cobotwire").stdout.splitlines()
    if shell == "zsh":  # three lines for each word: its type, the word, a description
        return set(lines[1::3])
    return {line.partition(",")[2].partition("\t")[0] for line in lines}


@pytest.mark.parametrize(
    ("shell", "line", "expected"),
    [("bash", *case) for case in CASES] + [(shell, *CASES[0]) for shell in SHELLS[1:]],
)
def test_words_are_completed_in_every_shell(shell: str, line: str, expected: set[str]) -> None:
    words = complete(shell, line)
    assert expected <= words
    start = line.split()[-1]
    assert all(word.startswith(start) for word in words)


def test_ports_are_completed_for_every_subcommand_that_opens_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # pyserial finds no port on most test machines, so the list is replaced.
    monkeypatch.setattr(serial_ports, "ports", lambda: [Port("/dev/ttyACM7", False, "", False)])
    completed = {
        name: [item.value for item in parameter.shell_complete(click.Context(each), "/dev/ttyA")]
        for name, each in subcommands()
        for parameter in each.params
        if isinstance(parameter, click.Argument) and parameter.metavar == "URL"
    }
    names = (
        "call",
        "doctor",
        "identify",
        "mcp",
        "monitor",
        "ros2",
        "survey",
        "tap",
        "conform device",
    )
    assert completed == {name: ["/dev/ttyACM7"] for name in names}


@pytest.mark.parametrize("shell", SHELLS)
def test_script_is_accepted_by_its_shell(shell: str, tmp_path: Path) -> None:
    script = run_program("completion", shell).stdout
    assert f"_COBOTWIRE_COMPLETE={shell}_complete" in script
    path = tmp_path / "script"
    path.write_text(script)
    result = subprocess.run(
        [needed(shell), "-n", path], capture_output=True, text=True, check=False
    )
    assert (result.returncode, result.stderr) == (0, "")


@pytest.fixture
def path_with_program(tmp_path: Path) -> str:
    """Return a search path on which the command line is the program cobotwire."""
    program = tmp_path / "cobotwire"
    program.write_text(f"#!/bin/sh\nexec {PROGRAM[0]} -c '{PROGRAM[2]}' \"$@\"\n")
    program.chmod(0o755)
    return f"{tmp_path}:{os.environ['PATH']}"


def needed(shell: str) -> str:
    program = shutil.which(shell)
    if program is None:
        pytest.skip(f"{shell} is not installed")
    return program


def test_bash_completes_with_the_printed_script(path_with_program: str) -> None:
    script = (
        'eval "$(cobotwire completion bash)"\n'
        "COMP_WORDS=(cobotwire call /dev/x get_enc); COMP_CWORD=3\n"
        "_cobotwire_completion cobotwire\n"
        'echo "${COMPREPLY[@]}"'
    )
    result = run_shell("bash", script, path_with_program)
    assert (result.stdout.split()[0], result.stderr) == ("get_encoder", "")


def test_fish_completes_with_the_printed_script(path_with_program: str) -> None:
    script = 'cobotwire completion fish | source; complete -C "cobotwire call /dev/x get_enc"'
    result = run_shell("fish", script, path_with_program)
    assert result.stdout.split()[0] == "get_encoder", result.stderr


def test_zsh_completes_what_is_typed_with_the_printed_script(
    tmp_path: Path, path_with_program: str
) -> None:
    needed("zsh")
    # A second zsh on a pseudo-terminal: completion works only where a user types.
    script = f"""
    zmodload zsh/zpty
    zpty shell 'TERM=dumb zsh -f -i'
    zpty -w shell "autoload -U compinit; compinit -u -d {tmp_path}/dump"
    zpty -w shell 'eval "$(cobotwire completion zsh)"; print rea''dy'
    zpty -r shell found '*ready*'
    zpty -w -n shell $'cobotwire sim --scenario pan\t'
    zpty -r shell found '*panic*' && print -r -- ${{found##*scenario }}
    zpty -d shell
    """
    result = run_shell("zsh", script, path_with_program)
    assert result.stdout.strip().startswith("panic"), result.stderr


def run_shell(shell: str, script: str, path: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [needed(shell), "-c", script],
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ, "PATH": path},
        check=False,
    )
