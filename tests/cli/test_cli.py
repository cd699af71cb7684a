"""Run the command line; check its output and exit code."""

from __future__ import annotations

import json
import os
import pty
import subprocess
import sys

import click
import pytest

from cobotwire import __version__
from cobotwire.cli.shared.hex_colours import frame_colours
from cobotwire.cli.shared.output import fold
from cobotwire.editions import mycobot280
from cobotwire.editions.mycobot import TABLE
from cobotwire.inspect import demo
from cobotwire.simulator import PtyServer, SimulatedArm
from command_line import run_program
from in_process import cobotwire as run


@pytest.mark.parametrize("codec", ["native", "reference"])
def test_demo_decodes_every_reply_correctly(codec: str) -> None:
    result = run("demo", "--codec", codec)
    assert result.returncode == 0, result.stderr
    assert f"with the {codec} codec" in result.stdout
    assert "8 of 8 replies are right" in result.stdout
    assert "FE FE 02 10 FA  power_on()" in result.stdout
    assert "moving: 100%" in result.stdout
    assert "\x1b[" not in result.stdout, "there is no colour without a terminal"


def test_demo_with_a_wrong_reply_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(demo, "OPENING", 55)
    monkeypatch.setattr(demo, "TOOL", demo.TOOL._replace(z=50.004))
    result = run("demo")
    assert result.returncode == 1
    assert "WRONG  get_tool_reference" in result.stdout
    assert "7 of 8 replies are right" in result.stdout


def test_help_lists_subcommands_and_exit_codes() -> None:
    result = run("--help")
    assert result.returncode == 0
    names = ("demo", "ports", "doctor", "monitor", "call", "decode", "sim", "replay", "commands")
    for word in (*names, "Exit codes"):
        assert word in result.stdout


def test_version_names_the_codec_in_use() -> None:
    assert run("--version").stdout == f"cobotwire {__version__}, native codec\n"
    forced = run_program("--version", COBOTWIRE_CODEC="reference")
    assert forced.stdout == f"cobotwire {__version__}, reference codec\n"
    assert run_program("--version", COBOTWIRE_CODEC="quick").returncode == 2


def test_call_prints_the_result(server: PtyServer) -> None:
    result = run("call", server.url, "get_angles")
    assert (result.returncode, result.stdout) == (
        0,
        "j1=0.0  j2=0.0  j3=0.0  j4=0.0  j5=0.0  j6=0.0\n",
    )
    as_json = run("call", server.url, "get_reference_frame", "--json")
    assert json.loads(as_json.stdout) == {"command": "get_reference_frame", "result": "BASE"}


def test_call_accepts_text_arguments_after_the_frame(server: PtyServer) -> None:
    call = ("--edition", "mycobot280", "call", server.url, "set_ssid_pwd")
    missing = run(*call, "home")
    assert (missing.returncode, "Traceback" in missing.stderr) == (2, False)
    assert (
        "set_ssid_pwd() is missing its argument password; it takes account, password"
        in missing.stderr
    )
    done = run(*call, "home", "password=a=b")
    assert done.returncode == 0, done.stderr


def test_call_accepts_lists_enum_names_and_negative_numbers(
    server: PtyServer, simulated: SimulatedArm
) -> None:
    call = ("call", server.url)
    assert run(*call, "power_on").returncode == 0
    moved = run(*call, "send_angles", "-10,0,0,0,0,5.5", "speed=100")
    assert moved.returncode == 0, moved.stderr
    assert run(*call, "set_end_type", "tool").returncode == 0
    assert run(*call, "set_digital_output", "23", "on").returncode == 0
    # Once a later query has its reply, the earlier one-way requests have arrived.
    assert run(*call, "is_power_on").stdout == "True\n"
    assert simulated.state.angles.target(0.0) == pytest.approx((-10, 0, 0, 0, 0, 5.5), abs=0.044)
    assert (simulated.state.kept["end_type"], simulated.state.kept["pins"]) == (1, {(23,): True})


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (["get_angels"], 2, "did you mean get_angles?"),
        (["send_angle", "1", "10"], 2, "send_angle() is missing its argument speed"),
        (["send_angle", "7", "10", "20"], 2, "joint is 7; allowed: a whole number 1..6"),
        (["send_angle", "1", "ten", "20"], 2, "angle is 'ten'; allowed: a number"),
        (["send_angles", *"12345", "80"], 2, "takes 7 numbers (6 for angles, 1 for speed), and 6"),
        (["send_angles", *"12345678"], 2, "takes 7 numbers (6 for angles, 1 for speed), and 8"),
        (["move_angles", *"12345678"], 2, "takes 7 numbers (6 for angles, 1 for speed), and 8"),
        (["send_angles", "0,ten,0,0,0,0", "30"], 2, "angles.j2 is 'ten'; allowed: a number"),
        (["set_color", "red"], 2, "red is 'red'; allowed: a number 0..255"),
        ([], 2, "call takes the port, then a command"),
        (["get_angles", "5"], 2, "get_angles() has no argument for '5'; it takes no arguments"),
        (["set_end_type", "FLANG"], 2, "allowed: FLANGE (0), TOOL (1)"),
        (["set_free_mode", "maybe"], 2, "allowed: on or off"),
    ],
)
def test_call_with_wrong_arguments_names_the_mistake(
    server: PtyServer, words: list[str], code: int, message: str
) -> None:
    result = run("call", server.url, *words)
    assert result.returncode == code
    assert message in result.stderr
    assert "Traceback" not in result.stderr


def test_missing_port_and_silent_arm_have_different_exit_codes() -> None:
    assert run("call", "/dev/nosuchport", "get_angles").returncode == 3
    master, slave = pty.openpty()
    try:
        silent = run("call", os.ttyname(slave), "get_angles", "--timeout", "0.1")
    finally:
        os.close(master)
        os.close(slave)
    assert silent.returncode == 4
    assert "no reply to get_angles" in silent.stderr


def test_decode_of_hex_explains_each_byte() -> None:
    result = run("decode", "FE FE 06 21 01 00 1D 14 FA")
    assert result.returncode == 0
    for line in (
        "request: send_angle(joint=1, angle=0.29 degrees, speed=20 percent)",
        "CMD            send_angle: Send one joint to an angle",
        "5  00 1D  angle          0.29 degrees",
        "8  FA     footer",
    ):
        assert line in result.stdout


def test_decode_of_an_illegal_frame_gives_the_reason() -> None:
    result = run("decode", "fefe06320101", "14", "0xFA")
    assert result.returncode == 1
    assert "LEN of the request 32 (jog_coord) is 06; allowed: 05" in result.stdout


def test_decode_prints_json() -> None:
    lines = run("decode", "--json", "FF FE FE 03 86 01 FA").stdout.splitlines()
    noise, frame = (json.loads(line) for line in lines)
    assert (noise["kind"], noise["reason"]) == ("noise", "no-header")
    assert frame["readings"] == [
        {"direction": "reply", "command": "get_reference_frame", "fields": {"frame": 1}}
    ]


def test_help_of_call_keeps_the_lines_of_its_examples() -> None:
    lines = [line.strip() for line in run("call", "--help").stdout.splitlines()]
    assert "cobotwire call /dev/ttyACM0 get_angles" in lines
    assert "cobotwire call /dev/ttyACM0 set_reference_frame WORLD" in lines
    assert "\\b" not in "".join(lines)


@pytest.mark.parametrize("words", [["commands"], ["commands", "stop"]])
def test_commands_prints_text_of_the_spec_without_markup(
    monkeypatch: pytest.MonkeyPatch, words: list[str]
) -> None:
    text = "the [bold]first[/] of :warning: [/nothing]"
    stop = mycobot280.TABLE.command("stop")._replace(title=text, doc=text, notes=(text,))
    monkeypatch.setattr(mycobot280, "TABLE", mycobot280.TABLE._replace(commands=(stop,)))
    result = run(*words)
    assert result.returncode == 0, result.stderr
    assert text in result.stdout


def test_commands_lists_every_command() -> None:
    for words, table in ((["--edition", "mycobot"], TABLE), ([], mycobot280.TABLE)):
        lines = run(*words, "commands").stdout.splitlines()
        assert len(lines) == len(table.commands) + 1
        assert any(line.startswith("0x2A  is_in_position") for line in lines)
        assert [line for line in lines if line.endswith(" ")] == []


def test_default_edition_is_mycobot280() -> None:
    assert "[default: mycobot280]" in " ".join(run("--help").stdout.split())
    assert "get_system_version" in run("decode", "FE FE 02 02 FA").stdout
    assert (
        "get_system_version" not in run("--edition", "mycobot", "decode", "FE FE 02 02 FA").stdout
    )


def test_commands_describes_one_command_byte_by_byte() -> None:
    result = run("--edition", "mycobot", "commands", "send_coord")
    for words in ("0x24  motion", "5-6   coord", "-3253.5..3300 millimetres (x 10)", "1 X, 2 Y"):
        assert words in result.stdout
    assert "Disputed" in result.stdout
    assert "<ssid>" in run("commands", "get_ssid_pwd").stdout
    [command] = json.loads(run("commands", "send_coord", "--json").stdout)
    assert (command["id"], command["request"][0]["fields"][0]["name"]) == (0x24, "axis")


def test_unknown_edition_gets_a_suggestion() -> None:
    result = run("--edition", "mycobt", "commands")
    assert result.returncode == 2
    assert "did you mean mycobot?" in result.stderr


@pytest.mark.parametrize(
    ("words", "further"),
    [
        (["--version"], set()),
        (["--help"], set()),
        (["decode", "FE FE 02 12 FA"], set()),
        (["conform", "cases", "--help"], {"cobotwire.cli.conform_device"}),
        (["sim", "--help"], {"cobotwire.editions.mercury_a1"}),
    ],
)
def test_start_imports_only_what_the_words_need(words: list[str], further: set[str]) -> None:
    code = "import sys; from cobotwire.cli import main; sys.argv[1:] = {}; main()"
    done = subprocess.run(
        [sys.executable, "-X", "importtime", "-c", code.format(words)],
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    imported = {line.split("|")[-1].strip() for line in done.stderr.splitlines()}
    unwanted = {"rich.console", "cobotwire.cli.replay", *further}
    if words[0] not in ("conform", "sim"):
        unwanted |= {"cobotwire.session", "cobotwire.client", "cobotwire.cli.sim"}
        unwanted |= {"cobotwire.codec.reference", "cobotwire.capture.reader"}
    assert not imported & unwanted
    assert "click" in imported


@pytest.mark.parametrize("columns", [16, 40, 80])
@pytest.mark.parametrize("line", ["noise   {}   bad", "  0.001 > {}", "{} {}", "one: {}  two"])
def test_hex_is_broken_between_bytes_on_a_terminal(
    monkeypatch: pytest.MonkeyPatch, columns: int, line: str
) -> None:
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", str(columns))
    frame = bytes.fromhex("FE FE 0F 2A 25 2E FF C3 FF C3 7D 00 FA") * 4
    text = line.format(*[frame_colours(TABLE.frame)(frame)] * 2)
    folded = fold(f"{text}\nnext")
    rows = click.unstyle(folded).split("\n")
    assert max(map(len, rows)) <= columns
    assert " ".join(folded.split()) == " ".join(f"{text} next".split())
    assert len(rows) <= 2 + len(click.unstyle(text)) // (columns // 2 - 3)
