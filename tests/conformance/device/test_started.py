"""The run starts the device, connects with it, notices when it dies, and stops it."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path

import pytest

import in_process
import vectors
from cobotwire import editions
from cobotwire.cli.app import app
from cobotwire.conformance import Cause, Verdict
from cobotwire.conformance.device import (
    DeviceConnection,
    StartedDevice,
    Step,
    Tester,
    parse_command,
)
from cobotwire.conformance.reports import from_json
from cobotwire.protocol.errors import LinkError, UsageError
from command_line import PROGRAM as COMMAND_LINE

# A busy machine may need long to start a program, in seconds.
STARTING = 60.0
TABLE = editions.load("mycobot280").TABLE
PROGRAM = [sys.executable, str(Path(__file__).with_name("device_program.py"))]
SERVED = [
    *COMMAND_LINE,
    *("--edition", "mycobot280", "sim", "--quiet"),
]
# How a program is connected: its command, and the option --attach.
CONNECTIONS: dict[str, tuple[list[str], str | None]] = {
    "standard input and output": ([*PROGRAM, "stdio"], None),
    "pseudo-terminal as standard input": ([*PROGRAM, "stdio"], "pty"),
    "pseudo-terminal by its path": ([*PROGRAM, "{port}"], None),
    "printed port": (SERVED, "port"),
    "printed URL": ([*SERVED, "--tcp", ":0"], "port"),
}


def first_queries(tester: Tester) -> list[Step]:
    return [step for step in tester.steps() if step.group.name == "queries"][:3]


@pytest.mark.parametrize("connection", CONNECTIONS)
def test_started_program_is_tested_and_stopped(connection: str) -> None:
    words, attachment = CONNECTIONS[connection]
    command, attach = parse_command(shlex.join(words), attachment)
    with StartedDevice(command, attach, TABLE.baudrate) as started:
        tester = Tester(DeviceConnection(started.transport), TABLE)
        assert tester.device.await_start(STARTING)
        for step in first_queries(tester):
            found = tester.results(step)
            assert {result.verdict for result in found} == {Verdict.PASS}, found
        assert started.ended() == ""
    assert started.ended()
    assert tester.report.subject.startswith("command ")


@pytest.mark.parametrize("how", ["stdio", "{port}"])
def test_program_that_dies_ends_the_run_at_once(how: str, tmp_path: Path) -> None:
    file = tmp_path / "report.json"
    command = shlex.join([*PROGRAM, how, "40"])
    words = ("conform", "device", "--command", command, "--json", str(file))
    ended = in_process.run(app, "cobotwire", *words, folder=vectors.ROOT)
    assert ended.returncode, ended.stdout
    report = from_json(file.read_text())
    assert (
        "it ended with code 1; its last diagnostics: the motor driver is on fire" in report.stopped
    )
    assert report.environment.port == report.subject
    assert any(result.verdict is Verdict.PASS for result in report.results)
    left = [result for result in report.results if result.cause is Cause.RUN_ENDED]
    assert len(left) > 50
    assert {result.reason for result in left} == {f"{report.stopped}."}


@pytest.mark.parametrize(
    ("command", "attach", "message"),
    [
        (["/nowhere/firmware"], "stdio", "cannot be started: No such file"),
        ([sys.executable, "-c", "raise SystemExit('no motors')"], "port", "code 1; .*no motors"),
    ],
)
def test_program_that_does_not_start_is_named(
    command: list[str], attach: str, message: str
) -> None:
    words, attachment = parse_command(shlex.join(command), attach)
    with pytest.raises(LinkError, match=message):
        StartedDevice(words, attachment, TABLE.baudrate)


@pytest.mark.parametrize(
    ("text", "attach", "message"),
    [
        ("", None, "is empty"),
        ("'unclosed", None, "No closing quotation"),
        ("firmware {port}", "stdio", "stands for a pseudo-terminal"),
        ("firmware", "serial", "attach is 'serial'"),
    ],
)
def test_text_that_is_not_a_command_is_rejected(
    text: str, attach: str | None, message: str
) -> None:
    with pytest.raises(UsageError, match=message):
        parse_command(text, attach)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--simulated", "--command", "x"), "give one of these"),
        ((), "give one of these"),
        (("--simulated", "--attach", "pty"), "--attach needs --command"),
    ],
)
def test_run_needs_exactly_one_device(words: tuple[str, ...], message: str) -> None:
    ended = in_process.run(app, "cobotwire", "conform", "device", *words, folder=vectors.ROOT)
    assert ended.returncode == 2
    assert message in ended.stderr
