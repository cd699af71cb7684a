"""Text that a peer, a file or another program chose is shown without control characters.

Each place that shows foreign text is listed here. It gets text with ESC, BEL, C1 controls,
bidirectional overrides, line ends and unpaired surrogates.
"""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import codec as codecs
from cobotwire.capture import CaptureWriter, Interface, Packet
from cobotwire.cli.app import app
from cobotwire.cli.shared.output import format_result
from cobotwire.cli.shared.simulator_output import Lines
from cobotwire.conformance.pytest_items import _in_full
from cobotwire.conformance.report import Exchange, Report, Result, Verdict
from cobotwire.conformance.reports import to_html, to_json, to_junit
from cobotwire.diagnose import Diagnoser, Finding, summarize
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol import errors
from cobotwire.protocol.printable import printable
from cobotwire.simulator.faults import AppliedFault
from cobotwire.transport.serial import ports as serial_ports
from scripted_peer import ScriptedPeer

# ESC sequences, BEL, a C1 control, a bidirectional override, a zero-width space, line ends.
CONTROLS = "\x1b[31m\x1b]0;title\x07\x9b1m\u202eevil\u200b\r\n\u2028\x7f$\\frac$"
HOSTILE = f"a{CONTROLS}\udc80b"
# A cause ends at its bracket, and is decoded as Latin-1; few damaged bytes in a row may be in it.
PANIC = (
    b"Guru Meditation Error: Core  1 panic'ed "
    b"(Load\x1b[2J\x1b]0;title\x07\x9b31mred\n\r \x85Prohibited). Exception was unhandled.\r\n"
    b"Rebooting...\r\n"
)
ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")


def is_clean(text: str, *, lines: bool = True) -> bool:
    """Return whether a text holds no character but printable ones, and line ends where allowed."""
    return all(part.isprintable() for part in (text.split("\n") if lines else [text]))


@given(st.text(st.characters(exclude_categories=())))
def test_printable_text_is_printable_and_stays_as_it_was(text: str) -> None:
    shown = printable(text)
    assert shown.isprintable()
    shown.encode()
    assert printable(shown) == shown
    if text.isprintable():
        assert shown == text


def test_escapes_are_those_of_python() -> None:
    assert printable("a\x1b\n\x9b\u202e\udc80é") == r"a\x1b\n\x9b\u202e\udc80é"


def _errors() -> Iterator[type[errors.CobotwireError]]:
    waiting = list(errors.CobotwireError.__subclasses__())
    while waiting:
        kind = waiting.pop()
        waiting += kind.__subclasses__()
        yield kind


# A value for a parameter of an error, by its annotation.
VALUES: dict[str, Any] = {
    "str": HOSTILE,
    "Any": HOSTILE,
    "int": 1,
    "int | None": 1,
    "WaitedFor | None": "turn",
    "float": 1.0,
    "bool": False,
    "bytes": HOSTILE.encode("utf-8", "surrogatepass"),
    "tuple[str, ...]": (HOSTILE, HOSTILE),
    "Sequence[str]": (HOSTILE, HOSTILE),
    "tuple[float, ...]": (1.0, 2.0),
    "ArmState": errors.ArmState((1.0, 2.0), False, True, 3, HOSTILE),
}


@pytest.mark.parametrize("kind", list(_errors()), ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("all_given", [True, False])
def test_text_of_an_error_is_printable(kind: type[errors.CobotwireError], all_given: bool) -> None:
    parameters = inspect.signature(kind.__init__).parameters
    given = {
        name: VALUES[str(parameter.annotation)]
        for name, parameter in parameters.items()
        if name != "self" and (all_given or parameter.default is parameter.empty)
    }
    error = kind(**given)
    assert is_clean(str(error), lines=kind in (errors.ScenarioError, errors.StatementError))
    # The data itself stays as it was.
    assert all(getattr(error, name, value) == value for name, value in given.items())


def findings(data: bytes) -> list[Finding]:
    """Return the diagnosis of bytes from the arm."""
    codec = codecs.load(TABLE)
    framer, diagnoser = codec.framer("reply"), Diagnoser(codec, "reply")
    items = diagnoser.feed(framer.feed(data) + framer.flush()) + diagnoser.flush()
    return [item for item in items if isinstance(item, Finding)]


TEXT = b"I (312) \x1b[0;33mwifi\x1b]0;x: reconnecting\x1b[0m\r\n"
BOOT = b"rst:0xc (SW_\x1bCPU_RESET),boot:0x13 \x1b[2J (SPI)\r\n"


@pytest.mark.parametrize("data", [PANIC, TEXT, BOOT, CONTROLS.encode() * 20], ids=repr)
def test_description_of_a_finding_is_printable(data: bytes) -> None:
    found = findings(data)
    assert found
    for finding in found:
        for text in (finding.describe(), finding.example(), finding.failure or ""):
            assert is_clean(text, lines=False)
    assert is_clean(summarize(found), lines=False)


def test_text_reply_is_shown_printable() -> None:
    assert is_clean(format_result(HOSTILE), lines=False)


def test_lines_of_the_simulator_are_printable() -> None:
    assert is_clean(Lines().fault(None, AppliedFault(0.0, HOSTILE, HOSTILE, HOSTILE, 0)))


def run(*words: str | Path, edition: str = "mycobot") -> str:
    """Run the CLI in this process; return everything that it printed."""
    result = CliRunner().invoke(app, ["--edition", edition, *map(str, words)])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result.output


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """Return a recording whose name, texts and panic are hostile; another program wrote it."""
    path = tmp_path / f"a{CONTROLS.replace('/', '')}.pcapng"
    with path.open("wb") as file:
        writer = CaptureWriter(file, CONTROLS)
        for _ in range(2):
            writer.interface(Interface(CONTROLS, "", 115200))
        for number, data in enumerate((ANGLES, PANIC, ANGLES)):
            noise = Packet(number * 10**9, "received", data, "noise", CONTROLS)
            writer.packet(noise)
            writer.packet(noise._replace(kind="frame", direction="unknown"))
    return path


@pytest.mark.parametrize("words", [["decode"], ["decode", "--summary"], ["replay"]], ids=" ".join)
@pytest.mark.parametrize("json", [[], ["--json"]], ids=["text", "json"])
def test_recording_is_shown_printable(recording: Path, words: list[str], json: list[str]) -> None:
    text = run(*words, recording, *json)
    assert "received" in text or "panic" in text or "<" in text
    assert is_clean(text)


@pytest.mark.parametrize("words", [["--summary"], ["--bytes"], ["--raw"]], ids=" ".join)
def test_bytes_are_decoded_printable(tmp_path: Path, words: list[str]) -> None:
    file = tmp_path / "arm.bin"
    file.write_bytes(PANIC + TEXT + BOOT + ANGLES)
    text = run("decode", file, *words)
    assert "panic" in text
    assert is_clean(text)


def test_notice_about_a_file_is_printable(tmp_path: Path) -> None:
    file = tmp_path / f"a{CONTROLS}.hex"
    file.write_text(ANGLES.hex())
    text = run("decode", file)
    assert "as hex text" in text
    assert is_clean(text)


@pytest.mark.parametrize(
    "words",
    [
        ["replay"],
        ["decode"],
        ["plot", "-o", "x.svg"],
        ["sim", "--scenario"],
        ["conform", "client", "--expect"],
        ["conform", "codec", "x", "--expected"],
        ["call", "URL", "get_angles"],
        ["call", "x"],
        ["call", "x", "is_power_on"],
        ["doctor"],
        ["monitor"],
        ["commands"],
    ],
    ids=" ".join,
)
def test_error_about_an_argument_is_printable(words: list[str]) -> None:
    text = run(*_fill(words, f"/nowhere/{HOSTILE}"))
    assert "a\\x1b" in text
    assert is_clean(text)


def _fill(words: list[str], value: str) -> list[str]:
    """Return the words with a value in place of URL, or at their end."""
    return [value if word == "URL" else word for word in [*words, *["URL"] * ("URL" not in words)]]


def test_plot_shows_file_and_port_as_they_are(recording: Path, tmp_path: Path) -> None:
    picture = tmp_path / "arm.svg"
    assert is_clean(run("plot", recording, "-o", picture))
    drawn = picture.read_text(encoding="utf-8")
    assert is_clean(drawn)
    # matplotlib names the text that it drew as shapes.
    assert len(re.findall(r"\\frac\$", drawn)) >= 1


@pytest.mark.parametrize(
    "subcommand",
    [
        ["call", "URL", "get_angles", "--timeout", "0.3"],
        ["doctor", "--count", "1", "--timeout", "0.2"],
        ["monitor", "--count", "1"],
        ["conform", "device", "--port"],
    ],
    ids=lambda subcommand: " ".join(subcommand[:2]),
)
@pytest.mark.parametrize("json", [False, True], ids=["text", "json"])
def test_what_the_arm_sends_is_shown_printable(subcommand: list[str], json: bool) -> None:
    words = ["--json"] if json and subcommand[0] != "conform" else []
    with ScriptedPeer(*[[PANIC]] * 200) as peer:
        text = run(*_fill(subcommand, peer.url), *words)
    assert "panic" in text or "conform" in subcommand
    assert is_clean(text)


def test_serial_ports_are_listed_printable(monkeypatch: pytest.MonkeyPatch) -> None:
    port = serial_ports.Port(HOSTILE, True, "a bridge", True, HOSTILE, "10C4:EA60", HOSTILE)
    monkeypatch.setattr(serial_ports, "ports", lambda: [port])
    assert is_clean(run("ports"))
    assert is_clean(run("ports", "--json"))


def report() -> Report:
    """Return a report about a hostile subject."""
    evidence = Exchange(0.0, "received", HOSTILE.encode("utf-8", "surrogatepass"), HOSTILE)
    results = [
        Result(HOSTILE, HOSTILE, verdict, HOSTILE, (evidence,), HOSTILE) for verdict in Verdict
    ]
    return Report("codec", "mycobot", HOSTILE, HOSTILE, HOSTILE, True, results, {HOSTILE: [1.0]})


def test_report_files_are_printable_and_well_formed() -> None:
    assert is_clean(to_json(report()))
    junit = to_junit(report())
    assert is_clean(junit)
    ElementTree.fromstring(junit)
    page = to_html(report())
    page.encode()
    assert is_clean(page)


def test_failure_in_pytest_is_printable() -> None:
    assert is_clean(_in_full(report().results[0]))


def test_comparison_of_reports_is_printable(tmp_path: Path) -> None:
    before, after = report(), report()
    before.results = []
    for name, each in (("before", before), ("after", after)):
        (tmp_path / name).write_text(to_json(each))
    text = run("conform", "compare", tmp_path / "before", tmp_path / "after")
    assert "\\x1b" in text
    assert is_clean(text)


GREETING = {"protocol": 1, "edition": "mycobot", "name": CONTROLS, "can": ["encode request"]}
# Code that a codec under test runs at its second question.
ENDS = {
    "replies": "print(json.dumps({'id': 2, 'bytes': CONTROLS, 'error': CONTROLS}), flush=True)",
    "prints something else": "print(CONTROLS, flush=True)",
    "ends with a complaint": "sys.stderr.write(''.join(CONTROLS.splitlines())); sys.exit(1)",
}


@pytest.mark.parametrize("end", ENDS)
def test_codec_under_test_is_reported_printable(tmp_path: Path, end: str) -> None:
    program = tmp_path / "codec.py"
    program.write_text(
        f"import json, sys\nCONTROLS = {CONTROLS!r}\nsys.stdin.readline()\n"
        f"print(json.dumps({{'id': 1}} | {GREETING!r}), flush=True)\n"
        f"sys.stdin.readline()\n{ENDS[end]}\nsys.stdin.read()\n"
    )
    text = run("conform", "codec", "--only", "*1", "--timeout", "1", "--", sys.executable, program)
    assert is_clean(text)
    assert text.lower().count("\\x1b[31m") > 1
